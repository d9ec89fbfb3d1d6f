#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/texture.h"
#include "spectra/color/reflectance_table.h"
#include "textures/clamped.h"
#include "textures/noise.h"
#include "textures/texture_mapping.h"

namespace frond {
namespace {

// ---- Mixtures of two textures ----

/// Smallest interval that contains both.
Interval interval_union(const Interval& a, const Interval& b) {
  return {std::min(a.min, b.min), std::max(a.max, b.max)};
}

/// Mixes two textures. `Share` returns the second one's share, 0 to 1, and reads its own parameters.
template <class Share>
class SharedFloat final : public FloatTexture {
 public:
  SharedFloat(const Params& p, const TexturePlacement& placement)
      : share_(p, placement), first_(p.float_texture(Share::kFirst)), second_(p.float_texture(Share::kSecond)) {}
  /// A texture with share 0 is not evaluated.
  float evaluate(const TexturePoint& at) const override {
    const float t = share_.second_share(at);
    return (t < 1 ? (1 - t) * first_->evaluate(at) : 0) + (t > 0 ? t * second_->evaluate(at) : 0);
  }
  Interval range() const override { return interval_union(first_->range(), second_->range()); }
  bool is_range_tight() const override { return first_->is_range_tight() && second_->is_range_tight(); }
  bool needs_details() const override { return share_.needs_details(); }

 private:
  Share share_;
  std::shared_ptr<const FloatTexture> first_, second_;
};

template <class Share>
class SharedSpectrum final : public SpectrumTexture {
 public:
  SharedSpectrum(const Params& p, const TexturePlacement& placement)
      : share_(p, placement), first_(p.spectrum_texture(Share::kFirst)), second_(p.spectrum_texture(Share::kSecond)) {}
  SampledSpectrum evaluate(const TexturePoint& at, const SampledWavelengths& lambda) const override {
    const float t = share_.second_share(at);
    SampledSpectrum sum;
    if (t < 1) sum += (1 - t) * first_->evaluate(at, lambda);
    if (t > 0) sum += t * second_->evaluate(at, lambda);
    return sum;
  }
  Interval range_nm() const override {
    const Interval a = first_->range_nm(), b = second_->range_nm();
    return {std::max(a.min, b.min), std::min(a.max, b.max)};
  }
  float max_value() const override { return std::max(first_->max_value(), second_->max_value()); }
  bool needs_details() const override { return share_.needs_details(); }

 private:
  Share share_;
  std::shared_ptr<const SpectrumTexture> first_, second_;
};

/// Alternating squares of side 1 in 2D, cubes in 3D, with values 1 and -1, filtered by a tent as wide as the footprint
/// (pbrt 4th ed., 10.6 of the online edition).
class Checkerboard {
 public:
  static constexpr std::string_view kFirst = "tex1", kSecond = "tex2";

  Checkerboard(const Params& p, const TexturePlacement& placement)
      : is_solid_(p.integer("dimension") == 3), mapping_(p, placement), solid_(placement) {}
  bool needs_details() const { return true; }
  /// The filtered product of square waves is the product of the filtered ones.
  float second_share(const TexturePoint& point) const {
    if (is_solid_) {
      const SolidCoordinates at = solid_.at(point);
      const auto sign = [&](float Vec3::*axis) {
        return filtered_square_wave(at.p.*axis, at.dp_dx.*axis, at.dp_dy.*axis);
      };
      return share(sign(&Vec3::x) * sign(&Vec3::y) * sign(&Vec3::z));
    }
    const TextureCoordinates at = mapping_.at(point);
    return share(filtered_square_wave(at.st.x, at.dst_dx.x, at.dst_dy.x) *
                 filtered_square_wave(at.st.y, at.dst_dx.y, at.dst_dy.y));
  }

 private:
  /// Converts 1 to share 0 and -1 to share 1; clamped for rounding of the filter.
  static float share(float sign) { return std::clamp(0.5f - 0.5f * sign, 0.f, 1.f); }
  /// Filtered square wave: 1 from an even number to the next, else -1.
  static float filtered_square_wave(float x, float dx, float dy) {
    // A tent is a box convolved with a box, so that the filtered wave is a second difference of its second integral.
    const float radius = 1.5f * std::max(std::abs(dx), std::abs(dy)), cell = std::floor(x);
    if (!std::isfinite(x) || !std::isfinite(radius)) return 0;
    const float in_period = x - 2 * std::floor(x / 2);
    if (std::floor(x - radius) == cell && std::floor(x + radius) == cell) return in_period < 1 ? 1 : -1;
    return float((second_integral(double(in_period) + double(radius)) - 2 * second_integral(double(in_period)) +
                  second_integral(double(in_period) - double(radius))) /
                 (double(radius) * double(radius)));
  }
  /// Second integral of the square wave. The first is a triangle wave from 0 to 1 with area 1 in each period of 2.
  static double second_integral(double x) {
    const double periods = std::floor(x / 2), up = x - 2 * periods, down = 2 - up;
    return periods + (up < 1 ? up * up / 2 : 1 - down * down / 2);
  }

  bool is_solid_;
  TextureMapping mapping_;
  SolidMapping solid_;
};

/// A disk in about every second cell, placed by noise.
class Dots {
 public:
  // In pbrt-v4, and therefore here, "inside" is the texture around the dots.
  static constexpr std::string_view kFirst = "inside", kSecond = "outside";

  Dots(const Params& p, const TexturePlacement& placement) : mapping_(p, placement) {}
  bool needs_details() const { return mapping_.needs_point(); }
  /// Position and presence of a dot are noise of its cell, with pbrt-v4's constants.
  float second_share(const TexturePoint& point) const {
    const Vec2 st = mapping_.at(point).st;
    const float s = std::floor(st.x + 0.5f), t = std::floor(st.y + 0.5f);
    // Dots do not cross the borders of their cells: radius plus largest shift is half a cell.
    constexpr float kRadius = 0.35f, kShift = 0.5f - kRadius, kZ = 0.5f;
    const auto noise = [&](float ds, float dt) { return perlin_noise({s + ds, t + dt, kZ}); };
    if (!(noise(0.5f, 0.5f) > 0)) return 0;
    const float ds = st.x - (s + kShift * noise(1.5f, 2.8f)), dt = st.y - (t + kShift * noise(4.5f, 9.8f));
    return ds * ds + dt * dt < kRadius * kRadius ? 1 : 0;
  }

 private:
  TextureMapping mapping_;
};

/// Selects the first texture where the normal is along a direction or opposite to it.
class DirectionMix {
 public:
  static constexpr std::string_view kFirst = "tex1", kSecond = "tex2";

  DirectionMix(const Params& p, const TexturePlacement& placement)
      : direction_(normalize_any(placement.world_from_texture.vector(p.vec3("dir")))) {
    if (direction_ == Vec3{}) fail(p.where("dir"), "\"dir\" has no direction: it is 0");
  }
  bool needs_details() const { return true; }
  /// Returns 0 for normals parallel to the direction, 1 for perpendicular ones.
  float second_share(const TexturePoint& point) const {
    return std::clamp(1 - std::abs(dot(point.n, direction_)), 0.f, 1.f);
  }

 private:
  Vec3 direction_;  ///< world space, unit
};

// ---- Interpolation of four corners ----

/// Extrapolates beyond the corners, clamped to their values.
std::array<float, 4> corner_weights(Vec2 st) {
  return {(1 - st.x) * (1 - st.y), (1 - st.x) * st.y, st.x * (1 - st.y), st.x * st.y};
}
constexpr std::array<std::string_view, 4> kCorners{"v00", "v01", "v10", "v11"};

/// Bilinear interpolation of four numbers over (u, v).
class BilerpFloat final : public FloatTexture {
 public:
  BilerpFloat(const Params& p, const TexturePlacement& placement) : mapping_(p, placement) {
    for (size_t i = 0; i < 4; ++i) v_[i] = float(p.real(kCorners[i]));
  }
  float evaluate(const TexturePoint& at) const override {
    const auto w = corner_weights(mapping_.at(at).st);
    return std::clamp(w[0] * v_[0] + w[1] * v_[1] + w[2] * v_[2] + w[3] * v_[3], float(range().min),
                      float(range().max));
  }
  Interval range() const override {
    const auto [low, high] = std::minmax_element(v_.begin(), v_.end());
    return {double(*low), double(*high)};
  }
  bool needs_details() const override { return mapping_.needs_point(); }

 private:
  TextureMapping mapping_;
  std::array<float, 4> v_{};
};

/// Bilinear interpolation of four spectra over (u, v).
class BilerpSpectrum final : public SpectrumTexture {
 public:
  BilerpSpectrum(const Params& p, const TexturePlacement& placement) : mapping_(p, placement) {
    for (size_t i = 0; i < 4; ++i) v_[i] = p.spectrum(kCorners[i]);
  }
  SampledSpectrum evaluate(const TexturePoint& at, const SampledWavelengths& lambda) const override {
    const auto w = corner_weights(mapping_.at(at).st);
    SampledSpectrum sum;
    for (size_t i = 0; i < 4; ++i) sum += w[i] * v_[i]->sample(lambda);
    return SampledSpectrum(clamped_to_unit(sum.v));
  }
  Interval range_nm() const override {
    Interval common = v_[0]->range_nm();
    for (const SpectrumPtr& s : v_)
      common = {std::max(common.min, s->range_nm().min), std::min(common.max, s->range_nm().max)};
    return common;
  }
  float max_value() const override {
    return std::max({v_[0]->max_value(), v_[1]->max_value(), v_[2]->max_value(), v_[3]->max_value()});
  }
  bool needs_details() const override { return mapping_.needs_point(); }

 private:
  TextureMapping mapping_;
  std::array<SpectrumPtr, 4> v_;
};

// ---- Noise ----

/// Parameters of a noise sum.
/// `gain` is the ratio of amplitudes of consecutive octaves.
struct Octaves {
  float gain;
  int count;
  explicit Octaves(const Params& p) : gain(float(p.real("roughness"))), count(p.integer("octaves")) {}
};

/// Fractal Brownian motion.
/// Octaves of the noise of Perlin 2002, "Improving Noise". The range is a bound, the sum of the amplitudes.
class Fbm final : public FloatTexture {
 public:
  Fbm(const Params& p, const TexturePlacement& placement) : mapping_(placement), octaves_(p) {}
  float evaluate(const TexturePoint& at) const override {
    return fractal_noise(mapping_.at(at), octaves_.gain, octaves_.count);
  }
  Interval range() const override {
    const double most = largest_sum(double(octaves_.gain), octaves_.count);
    return {-most, most};
  }
  bool is_range_tight() const override { return false; }
  bool needs_details() const override { return true; }

 private:
  SolidMapping mapping_;
  Octaves octaves_;
};

/// Turbulence: octaves of absolute noise.
class Wrinkled final : public FloatTexture {
 public:
  Wrinkled(const Params& p, const TexturePlacement& placement) : mapping_(placement), octaves_(p) {}
  float evaluate(const TexturePoint& at) const override {
    return turbulence(mapping_.at(at), octaves_.gain, octaves_.count);
  }
  Interval range() const override {
    const double most = largest_sum(double(octaves_.gain), octaves_.count);
    return {octaves_.gain < 0 ? -most : 0, most};
  }
  bool is_range_tight() const override { return false; }
  bool needs_details() const override { return true; }

 private:
  SolidMapping mapping_;
  Octaves octaves_;
};

/// Water waves, higher in gusts.
class Windy final : public FloatTexture {
 public:
  Windy(const Params&, const TexturePlacement& placement) : mapping_(placement) {}
  float evaluate(const TexturePoint& point) const override {
    const SolidCoordinates at = mapping_.at(point);
    // Gusts have a tenth of the frequency of the waves, as in pbrt-v4.
    constexpr float kGusts = 0.1f;
    const float wind = fractal_noise({kGusts * at.p, kGusts * at.dp_dx, kGusts * at.dp_dy}, kGain, kGustOctaves);
    return std::abs(wind) * fractal_noise(at, kGain, kWaveOctaves);
  }
  Interval range() const override {
    const double most = largest_sum(double(kGain), kGustOctaves) * largest_sum(double(kGain), kWaveOctaves);
    return {-most, most};
  }
  bool is_range_tight() const override { return false; }
  bool needs_details() const override { return true; }

 private:
  static constexpr float kGain = 0.5f;
  static constexpr int kGustOctaves = 3, kWaveOctaves = 6;
  SolidMapping mapping_;
};

/// Marble: layers along y, perturbed by noise, coloured by a spline.
class Marble final : public SpectrumTexture {
 public:
  Marble(const Params& p, const TexturePlacement& placement)
      : mapping_(placement),
        octaves_(p),
        scale_(float(p.real("scale"))),
        variation_(float(p.real("variation"))),
        table_(ReflectanceTable::srgb()) {}
  SampledSpectrum evaluate(const TexturePoint& point, const SampledWavelengths& lambda) const override {
    SolidCoordinates at = mapping_.at(point);
    at = {scale_ * at.p, scale_ * at.dp_dx, scale_ * at.dp_dy};
    const float layer = at.p.y + variation_ * fractal_noise(at, octaves_.gain, octaves_.count);
    return table_.sample(color(0.5f + 0.5f * std::sin(layer)), lambda);
  }
  Interval range_nm() const override { return {360, 830}; }
  float max_value() const override { return 1; }
  bool needs_details() const override { return true; }

 private:
  /// Spline of cubic Bézier curves over four colours in turn, from 0 to 1; the colours are from pbrt-v4 (Apache 2.0).
  static Float4 color(float t) {
    constexpr Float4 kLight{.58f, .58f, .6f, 0};
    constexpr std::array<Float4, 9> kColors{kLight,
                                            kLight,
                                            kLight,
                                            Float4{.5f, .5f, .5f, 0},
                                            Float4{.6f, .59f, .58f, 0},
                                            kLight,
                                            kLight,
                                            Float4{.2f, .2f, .33f, 0},
                                            kLight};
    constexpr int kCurves = int(kColors.size()) - 3;
    if (!(t >= 0)) t = 0;
    const int first = std::min(int(t * kCurves), kCurves - 1);
    const float x = t * kCurves - float(first), y = 1 - x;
    const Float4* c = &kColors[size_t(first)];
    const Float4 sum = y * y * y * c[0] + 3 * y * y * x * c[1] + 3 * y * x * x * c[2] + x * x * x * c[3];
    // pbrt-v4's factor; the largest component of the colours is 0.6, so that the result is at most 0.9.
    return 1.5f * sum;
  }

  SolidMapping mapping_;
  Octaves octaves_;
  float scale_, variation_;
  const ReflectanceTable& table_;
};

// ---- Parameters ----

constexpr Param texture_param(std::string_view name, ParamKind kind, double value, std::string_view doc) {
  return {.name = name, .kind = kind, .default_value = value, .doc = doc};
}
constexpr ParamKind kFloat = ParamKind::float_texture, kSpectrum = ParamKind::spectrum_texture;

constexpr Param kDimension{.name = "dimension",
                           .kind = ParamKind::integer,
                           .default_value = 2,
                           .range = {2, 3},
                           .doc = "2: squares in (u, v) or another mapping; 3: cubes in the texture's space."};
constexpr std::string_view kEven = "Value of cells whose integer coordinates have an even sum.",
                           kOdd = "Value of the other cells.", kAround = "Value around the dots, as in pbrt-v4.",
                           kInDots = "Value in the dots.", kAlong = "Value for normals parallel to \"dir\".",
                           kAcross = "Value for normals perpendicular to \"dir\".";
constexpr Param kCheckerFloat[] = {texture_param("tex1", kFloat, 1, kEven), texture_param("tex2", kFloat, 0, kOdd),
                                   kDimension};
constexpr Param kCheckerSpectrum[] = {texture_param("tex1", kSpectrum, 1, kEven),
                                      texture_param("tex2", kSpectrum, 0, kOdd), kDimension};
constexpr Param kDotsFloat[] = {texture_param("inside", kFloat, 1, kAround),
                                texture_param("outside", kFloat, 0, kInDots)};
constexpr Param kDotsSpectrum[] = {texture_param("inside", kSpectrum, 1, kAround),
                                   texture_param("outside", kSpectrum, 0, kInDots)};
constexpr Param kBilerpFloat[] = {
    texture_param("v00", ParamKind::real, 0, "At (0, 0)."), texture_param("v01", ParamKind::real, 1, "At (0, 1)."),
    texture_param("v10", ParamKind::real, 0, "At (1, 0)."), texture_param("v11", ParamKind::real, 1, "At (1, 1).")};
constexpr Param kBilerpSpectrum[] = {
    texture_param("v00", ParamKind::albedo, 0, "At (0, 0)."), texture_param("v01", ParamKind::albedo, 1, "At (0, 1)."),
    texture_param("v10", ParamKind::albedo, 0, "At (1, 0)."), texture_param("v11", ParamKind::albedo, 1, "At (1, 1).")};
constexpr auto kCheckerFloatParams = with_mapping(kCheckerFloat);
constexpr auto kCheckerSpectrumParams = with_mapping(kCheckerSpectrum);
constexpr auto kDotsFloatParams = with_mapping(kDotsFloat);
constexpr auto kDotsSpectrumParams = with_mapping(kDotsSpectrum);
constexpr auto kBilerpFloatParams = with_mapping(kBilerpFloat);
constexpr auto kBilerpSpectrumParams = with_mapping(kBilerpSpectrum);

constexpr Param kDirection{.name = "dir",
                           .kind = ParamKind::vector3,
                           .default_value = std::array<double, 3>{0, 1, 0},
                           .doc = "Direction in texture space, of any length."};
constexpr Param kDirectionFloat[] = {texture_param("tex1", kFloat, 0, kAlong),
                                     texture_param("tex2", kFloat, 1, kAcross), kDirection};
constexpr Param kDirectionSpectrum[] = {texture_param("tex1", kSpectrum, 0, kAlong),
                                        texture_param("tex2", kSpectrum, 1, kAcross), kDirection};

constexpr Param kOctaves{.name = "octaves",
                         .kind = ParamKind::integer,
                         .default_value = 8,
                         .range = {0, 64},
                         .doc = "Number of octaves; octaves finer than the footprint are omitted."};
constexpr Param kRoughness{.name = "roughness",
                           .kind = ParamKind::real,
                           .default_value = 0.5,
                           .range = {-4, 4},
                           .doc = "Ratio of amplitudes of consecutive octaves."};
constexpr Param kNoise[] = {kOctaves, kRoughness};
constexpr Param kMarble[] = {
    kOctaves,
    kRoughness,
    {.name = "scale", .kind = ParamKind::real, .default_value = 1.0, .doc = "Factor of the coordinates."},
    {.name = "variation",
     .kind = ParamKind::real,
     .default_value = 0.2,
     .doc = "Amplitude of the noise that bends the layers."}};

}  // namespace

extern const FloatTextureInfo checkerboard_float_texture{
    {"float texture", "checkerboard", "Checkerboard of two textures, filtered over the footprint.", "pbrt-v4",
     kCheckerFloatParams},
    make_placed<FloatTexture, SharedFloat<Checkerboard>>};
extern const SpectrumTextureInfo checkerboard_spectrum_texture{
    {"spectrum texture", "checkerboard", "Checkerboard of two textures, filtered over the footprint.", "pbrt-v4",
     kCheckerSpectrumParams},
    make_placed<SpectrumTexture, SharedSpectrum<Checkerboard>>};
extern const FloatTextureInfo dots_float_texture{
    {"float texture", "dots", "Dots at random places.", "pbrt-v4", kDotsFloatParams},
    make_placed<FloatTexture, SharedFloat<Dots>>};
extern const SpectrumTextureInfo dots_spectrum_texture{
    {"spectrum texture", "dots", "Dots at random places.", "pbrt-v4", kDotsSpectrumParams},
    make_placed<SpectrumTexture, SharedSpectrum<Dots>>};
extern const FloatTextureInfo direction_mix_float_texture{
    {"float texture", "directionmix", "Mixture of two textures by the shading normal.", "pbrt-v4", kDirectionFloat},
    make_placed<FloatTexture, SharedFloat<DirectionMix>>};
extern const SpectrumTextureInfo direction_mix_spectrum_texture{
    {"spectrum texture", "directionmix", "Mixture of two textures by the shading normal.", "pbrt-v4",
     kDirectionSpectrum},
    make_placed<SpectrumTexture, SharedSpectrum<DirectionMix>>};
extern const FloatTextureInfo bilerp_float_texture{
    {"float texture", "bilerp", "Bilinear interpolation of four numbers at the corners.", "pbrt-v4",
     kBilerpFloatParams},
    make_placed<FloatTexture, BilerpFloat>};
extern const SpectrumTextureInfo bilerp_spectrum_texture{
    {"spectrum texture", "bilerp", "Bilinear interpolation of four spectra at the corners.", "pbrt-v4",
     kBilerpSpectrumParams},
    make_placed<SpectrumTexture, BilerpSpectrum>};
extern const FloatTextureInfo fbm_float_texture{
    {"float texture", "fbm", "Fractal noise: a sum of octaves.", "Perlin 2002, pbrt-v4", kNoise},
    make_placed<FloatTexture, Fbm>};
extern const FloatTextureInfo wrinkled_float_texture{
    {"float texture", "wrinkled", "Turbulence: a sum of magnitudes of octaves.", "Perlin 2002, pbrt-v4", kNoise},
    make_placed<FloatTexture, Wrinkled>};
extern const FloatTextureInfo windy_float_texture{{"float texture", "windy", "Waves and gusts of wind.", "pbrt-v4", {}},
                                                  make_placed<FloatTexture, Windy>};
extern const SpectrumTextureInfo marble_spectrum_texture{
    {"spectrum texture", "marble", "Veins of marble.", "Perlin 2002, pbrt-v4", kMarble},
    make_placed<SpectrumTexture, Marble>};

}  // namespace frond
