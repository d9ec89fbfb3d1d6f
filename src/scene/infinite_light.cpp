#include <map>
#include <numbers>

#include "core/error.h"
#include "core/sampling.h"
#include "image/rgb_file.h"
#include "scene/distribution.h"
#include "scene/registry.h"
#include "spectra/cie.h"
#include "spectra/color_space.h"
#include "spectra/rgb_upsampling.h"

namespace frond {
namespace {

class ConstantEnvironment final : public EnvironmentLight {
 public:
  explicit ConstantEnvironment(const Params& p, float scale) : spectrum_(p.spectrum("L")), scale_(scale) {}
  std::optional<LightSample> sample(const Vec3&, Vec2 u, const SampledWavelengths& lambda) const override {
    const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.f, 1 - z * z)), phi = 2 * kPi * u.y;
    return LightSample{
        spectrum_->sample(lambda) * scale_, {r * std::cos(phi), r * std::sin(phi), z}, INFINITY, kUniformPdf};
  }
  SampledSpectrum radiance(const Vec3&, const Vec3&, const SampledWavelengths& lambda) const override {
    return spectrum_->sample(lambda) * scale_;
  }
  float pdf(const Vec3&, const Vec3&) const override { return kUniformPdf; }
  /// Scattered rays go where a surface weighs the sky most; uniform ones do not.
  double competing_share() const override { return 0; }
  bool is_delta() const override { return false; }
  double power(float radius) const override {
    constexpr double pi = std::numbers::pi;
    return 4 * pi * pi * double(radius) * double(radius) * double(scale_) * photometric(*spectrum_);
  }
  const Spectrum& emission() const override { return *spectrum_; }

 private:
  static constexpr float kUniformPdf = 0.25f * kInvPi;
  SpectrumPtr spectrum_;
  float scale_;
};

/// Equal-area map between the unit square and the sphere: the octahedron's faces side by side (Clarberg 2008, "Fast
/// Equal-Area Mapping of the (Hemi)Sphere using SIMD").
Vec3 sphere_from_square(Vec2 u) {
  const float x = 2 * u.x - 1, y = 2 * u.y - 1, ax = std::abs(x), ay = std::abs(y);
  const float d = 1 - (ax + ay), r = 1 - std::abs(d);
  const float phi = (r == 0 ? 1 : (ay - ax) / r + 1) * kPi / 4, ring = r * std::sqrt(std::max(0.f, 2 - r * r));
  return {std::copysign(std::cos(phi), x) * ring, std::copysign(std::sin(phi), y) * ring, std::copysign(1 - r * r, d)};
}

Vec2 square_from_sphere(const Vec3& d) {
  const float ax = std::abs(d.x), ay = std::abs(d.y), r = std::sqrt(std::max(0.f, 1 - std::abs(d.z)));
  const float phi = ax == 0 && ay == 0 ? 0 : std::atan2(ay, ax) * 2 * kInvPi;
  float v = phi * r, u = r - v;
  if (d.z < 0) {
    const float swapped = 1 - v;
    v = 1 - u;
    u = swapped;
  }
  return {(std::copysign(u, d.x) + 1) / 2, (std::copysign(v, d.y) + 1) / 2};
}

/// A square image over the sphere, as pbrt-v4 has it; constant within each texel.
class ImageEnvironment final : public EnvironmentLight {
 public:
  ImageEnvironment(const Params& p, const Transform& world_from_light)
      : ImageEnvironment(p, world_from_light, load(p)) {}

  std::optional<LightSample> sample(const Vec3&, Vec2 u, const SampledWavelengths& lambda) const override {
    return sample_from(texels_by_power_, u, lambda);
  }
  std::optional<LightSample> sample_competing(const Vec3&, Vec2 u, const SampledWavelengths& lambda) const override {
    return sample_from(texels_by_excess_, u, lambda);
  }
  SampledSpectrum radiance(const Vec3&, const Vec3& direction, const SampledWavelengths& lambda) const override {
    return at(to_square(direction), lambda);
  }
  float pdf(const Vec3&, const Vec3& direction) const override {
    return texels_by_power_.pdf(to_square(direction)) * kPerSphere;
  }
  float competing_pdf(const Vec3&, const Vec3& direction) const override {
    return texels_by_excess_.pdf(to_square(direction)) * kPerSphere;
  }
  double competing_share() const override { return excess_share_; }
  bool is_delta() const override { return false; }
  double power(float radius) const override {
    constexpr double pi = std::numbers::pi;
    return 4 * pi * pi * double(radius) * double(radius) * mean_luminance_;
  }
  const Spectrum& emission() const override { return *white_; }

 private:
  static constexpr float kPerSphere = 0.25f * kInvPi;
  static constexpr double kLeastExcess = 0.01;  ///< what is as even as this is left to scattered rays
  struct Color {
    SigmoidPolynomial reflectance;
    float scale;
  };

  static Image load(const Params& p) {
    ImageFile file = read_rgb(p.file("filename"), p.where("filename"));
    if (file.eight_bit) decode_srgb(file.image);
    return std::move(file.image);
  }

  ImageEnvironment(const Params& p, const Transform& world_from_light, const Image& image)
      : world_from_light_(world_from_light),
        light_from_world_(world_from_light.inverse()),
        size_(image.width),
        white_(unit_d65()),
        texels_by_power_(luminances(image), image.width),
        texels_by_excess_(excesses(image), image.width) {
    if (image.width != image.height)
      fail(p.where("filename"),
           "the image is {} x {}: an environment is square, in pbrt-v4's equal-area map of the sphere", image.width,
           image.height);
    const float scale = float(p.real("scale"));
    std::map<std::array<float, 3>, uint32_t> known;
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
      const std::array<float, 3> c{image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]};
      const auto [it, is_new] = known.emplace(c, uint32_t(colors_.size()));
      if (is_new) colors_.push_back(color(c, scale, p.where("filename")));
      texels_.push_back(it->second);
    }
    const double mean = mean_of(luminances(image));
    mean_luminance_ = double(scale) * mean;
    excess_share_ = mean > 0 ? mean_of(excesses(image)) / mean : 1;
    if (excess_share_ < kLeastExcess) excess_share_ = 0;
    if (p.given("illuminance"))
      fail(p.where("illuminance"), "\"illuminance\" of an image is not supported yet: use \"scale\"");
  }

  static Color color(const std::array<float, 3>& c, float scale, const Location& where) {
    for (const float v : c)
      if (!(v >= 0 && std::isfinite(v)))
        fail(where, "the image holds the value {}: radiance is not negative and finite", v);
    // Twice the brightest channel leaves the reflectance room on both sides.
    const double peak = 2 * double(std::max({c[0], c[1], c[2]}));
    if (peak == 0) return {SigmoidPolynomial({0, 0, 0}), 0};
    const auto fit =
        fit_reflectance(color_space("srgb", {}), {double(c[0]) / peak, double(c[1]) / peak, double(c[2]) / peak});
    return {fit.reflectance, float(peak) * scale};
  }
  static std::vector<float> luminances(const Image& image) {
    const Triple& y = color_space("srgb", {}).xyz_from_rgb.row[1];
    std::vector<float> result;
    for (size_t i = 0; i < image.pixels.size(); i += 3)
      result.push_back(std::max(
          0.f, float(y[0]) * image.pixels[i] + float(y[1]) * image.pixels[i + 1] + float(y[2]) * image.pixels[i + 2]));
    return result;
  }
  /// What is above the mean: scattered rays find an even light as well (Karlík et al. 2019, "MIS Compensation:
  /// Optimizing Sampling Techniques in Multiple Importance Sampling").
  static std::vector<float> excesses(const Image& image) {
    std::vector<float> result = luminances(image);
    const auto mean = float(mean_of(result));
    for (float& v : result) v = std::max(0.f, v - mean);
    return result;
  }
  static double mean_of(const std::vector<float>& values) {
    double sum = 0;
    for (const float v : values) sum += double(v);
    return sum / double(values.size());
  }
  std::optional<LightSample> sample_from(const Distribution2D& texels, Vec2 u, const SampledWavelengths& lambda) const {
    const auto [uv, density] = texels.sample(u);
    if (!(density > 0)) return {};
    return LightSample{at(uv, lambda), normalize(world_from_light_.vector(sphere_from_square(uv))), INFINITY,
                       density * kPerSphere};
  }
  Vec2 to_square(const Vec3& direction) const {
    return square_from_sphere(normalize(light_from_world_.vector(direction)));
  }
  size_t index(Vec2 uv) const {
    const auto cell = [this](float t) { return size_t(std::clamp(int(t * float(size_)), 0, size_ - 1)); };
    return cell(uv.y) * size_t(size_) + cell(uv.x);
  }
  SampledSpectrum at(Vec2 uv, const SampledWavelengths& lambda) const {
    const Color& c = colors_[texels_[index(uv)]];
    SampledSpectrum s = white_->sample(lambda);
    for (int i = 0; i < lambda.count; ++i) s[i] *= c.scale * c.reflectance.at(lambda.nm[size_t(i)]);
    return s;
  }

  Transform world_from_light_, light_from_world_;
  int size_;
  SpectrumPtr white_;
  Distribution2D texels_by_power_, texels_by_excess_;
  std::vector<uint32_t> texels_;
  std::vector<Color> colors_;
  double mean_luminance_ = 0, excess_share_ = 0;
};

constexpr Param kInfinite[] = {
    {.name = "L",
     .kind = ParamKind::illuminant,
     .default_value = std::array<double, 3>{1, 1, 1},
     .doc = "Radiance; spectra are normalised to luminance 1."},
    {.name = "filename",
     .kind = ParamKind::string,
     .doc = "Square image in the equal-area map of pbrt-v4, linear sRGB; in place of L."},
    {.name = "scale", .kind = ParamKind::real, .default_value = 1.0, .range = kAtLeastZero, .doc = "Factor."},
    {.name = "illuminance",
     .kind = ParamKind::real,
     .unit = "lx",
     .range = kAtLeastZero,
     .doc = "Illuminance of a surface under the upper half, in place of the radiance's own."},
};

std::unique_ptr<Light> make_infinite(const Params& p, const Transform& world_from_light) {
  if (p.given("filename")) {
    if (p.given("L")) fail(p.where("L"), "\"L\" and \"filename\" exclude each other");
    return std::make_unique<ImageEnvironment>(p, world_from_light);
  }
  const double scale =
      p.given("illuminance") ? p.real("scale") * p.real("illuminance") / std::numbers::pi : p.real("scale");
  return std::make_unique<ConstantEnvironment>(p, float(scale));
}

}  // namespace

extern const LightInfo infinite_light{
    {"light", "infinite", "Light from all around: the same everywhere, or an image.", "pbrt-v4", kInfinite},
    make_infinite};

}  // namespace frond
