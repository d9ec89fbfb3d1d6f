#include <numbers>

#include "core/error.h"
#include "scene/distribution.h"
#include "scene/equal_area.h"
#include "scene/light_image.h"
#include "scene/registry.h"
#include "spectra/cie.h"

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

ColorImage read_square_image(const Params& p) {
  ColorImage file = read_light_image(p);
  const Image& image = file.image;
  if (image.width != image.height)
    fail(p.where("filename"),
         "the image is {} x {}: an environment is square, in pbrt-v4's equal-area map of the sphere; pbrt-v4's "
         "\"imgtool "
         "makeequiarea\" makes one of a map by latitude and longitude",
         image.width, image.height);
  return file;
}

/// pbrt-v4's measure of an image's illuminance on the upper half of its own space. It is half of the illuminance.
double illuminance_of(const ColorImage& file) {
  const std::vector<float> luminances = luminances_of(file);
  const auto width = size_t(file.image.width);
  double sum = 0;
  for (size_t i = 0; i < luminances.size(); ++i) {
    const Vec2 center{float(i % width) + 0.5f, float(i / width) + 0.5f};
    const float cosine = sphere_from_square(center * (1 / float(width))).z;
    if (cosine > 0) sum += double(luminances[i]) * double(cosine);
  }
  return sum * 2 * std::numbers::pi / double(luminances.size());
}

/// "scale", or what brings the image to "illuminance".
float image_scale(const Params& p, const ColorImage& file) {
  if (!p.given("illuminance")) return float(p.real("scale"));
  const double own = illuminance_of(file);
  if (!(own > 0)) fail(p.where("illuminance"), "the upper half of the image is black: it has no illuminance to scale");
  p.warn("illuminance", "as in pbrt-v4, a surface under the upper half of the image gets twice this illuminance");
  return float(p.real("scale") * p.real("illuminance") / own);
}

/// A square image over the sphere, as pbrt-v4 has it; constant within each texel.
class ImageEnvironment final : public EnvironmentLight {
 public:
  ImageEnvironment(const Params& p, const Transform& world_from_light)
      : ImageEnvironment(p, world_from_light, read_square_image(p)) {}

  std::optional<LightSample> sample(const Vec3&, Vec2 u, const SampledWavelengths& lambda) const override {
    return sample_from(texels_by_power_, u, lambda);
  }
  std::optional<LightSample> sample_competing(const Vec3&, Vec2 u, const SampledWavelengths& lambda) const override {
    return sample_from(texels_by_excess_, u, lambda);
  }
  SampledSpectrum radiance(const Vec3&, const Vec3& direction, const SampledWavelengths& lambda) const override {
    return image_.nearest(to_square(direction), lambda) * scale_;
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
    return 4 * pi * pi * double(radius) * double(radius) * double(scale_) * image_.mean_luminance();
  }
  const Spectrum& emission() const override { return *image_.white(); }

 private:
  static constexpr float kPerSphere = 0.25f * kInvPi;
  static constexpr double kLeastExcess = 0.01;  ///< what is as even as this is left to scattered rays

  ImageEnvironment(const Params& p, const Transform& world_from_light, const ColorImage& file)
      : world_from_light_(world_from_light),
        light_from_world_(world_from_light.inverse()),
        image_(file),
        scale_(image_scale(p, file)),
        texels_by_power_(image_.luminances(), image_.width()),
        texels_by_excess_(excesses(image_), image_.width()) {
    const double mean = image_.mean_luminance();
    excess_share_ = mean > 0 ? mean_of(excesses(image_)) / mean : 1;
    if (excess_share_ < kLeastExcess) excess_share_ = 0;
  }

  /// What is above the mean: scattered rays find an even light as well (Karlík et al. 2019, "MIS Compensation:
  /// Optimizing Sampling Techniques in Multiple Importance Sampling").
  static std::vector<float> excesses(const LightImage& image) {
    std::vector<float> result = image.luminances();
    const auto mean = float(image.mean_luminance());
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
    return LightSample{image_.nearest(uv, lambda) * scale_, normalize(world_from_light_.vector(sphere_from_square(uv))),
                       INFINITY, density * kPerSphere};
  }
  Vec2 to_square(const Vec3& direction) const {
    return square_from_sphere(normalize(light_from_world_.vector(direction)));
  }

  Transform world_from_light_, light_from_world_;
  LightImage image_;
  float scale_;
  Distribution2D texels_by_power_, texels_by_excess_;
  double excess_share_ = 0;
};

/// A rectangle that light from outside comes through, on the way against its axis. Directions through it are a window
/// of the square of their angles along its sides (Bitterli et al. 2015, "Portal-Masked Environment Map Sampling").
class Portal {
 public:
  explicit Portal(const Params& p) {
    const std::vector<Vec3> corners = p.vec3s("portal");
    const Location where = p.where("portal");
    if (corners.size() != 4) fail(where, "\"portal\" takes 4 points, {} given", corners.size());
    const Vec3 right = corners[3] - corners[0], up = corners[1] - corners[0];
    const Vec3 x = normalize_any(right), y = normalize_any(up);
    const Vec3 far_x = normalize_any(corners[2] - corners[1]), far_y = normalize_any(corners[2] - corners[3]);
    constexpr float kTolerance = 1e-3f;  // pbrt-v4's
    if (!(std::abs(dot(x, far_x) - 1) < kTolerance && std::abs(dot(y, far_y) - 1) < kTolerance &&
          std::abs(dot(x, y)) < kTolerance && std::abs(dot(far_x, far_y)) < kTolerance))
      fail(where, "\"portal\" is no rectangle: its corners are needed in turn");
    first_ = corners[0], opposite_ = corners[2];
    frame_ = {x, y, normalize_any(cross(x, y))};
    area_ = length(to_double(right)) * length(to_double(up));
  }

  struct Direction {
    Vec3 w;            ///< unit, world space
    float steradians;  ///< for each unit of the square
  };
  /// On the side where light comes from.
  std::optional<Vec2> square_of(const Vec3& w, float* steradians = nullptr) const {
    const Vec3 d = frame_.to_local(w);
    if (!(d.z > 0)) return {};
    if (steradians) *steradians = jacobian(d);
    const auto at = [&](float t) { return std::clamp(std::atan2(t, d.z) * kInvPi + 0.5f, 0.f, 1.f); };
    return Vec2{at(d.x), at(d.y)};
  }
  Direction direction_of(Vec2 uv) const {
    const auto tangent = [](float t) { return std::tan((t - 0.5f) * kPi); };
    const Vec3 d = normalize_any(Vec3{tangent(uv.x), tangent(uv.y), 1});
    return {frame_.to_world(d), jacobian(d)};
  }
  /// What can be seen through it from a point; nothing from behind.
  std::optional<WindowedDistribution::Window> window_at(const Vec3& from) const {
    const auto a = square_of(normalize_any(first_ - from)), b = square_of(normalize_any(opposite_ - from));
    if (!a || !b) return {};
    return WindowedDistribution::Window{{std::min(a->x, b->x), std::min(a->y, b->y)},
                                        {std::max(a->x, b->x), std::max(a->y, b->y)}};
  }
  double area() const { return area_; }
  float cosine(const Vec3& w) const { return dot(frame_.z, w); }

 private:
  static float jacobian(const Vec3& d) { return kPi * kPi * (1 - d.x * d.x) * (1 - d.y * d.y) / d.z; }

  Frame frame_;
  Vec3 first_, opposite_;
  double area_ = 0;
};

/// Seen through a portal, and nowhere else.
class PortalEnvironment final : public EnvironmentLight {
 public:
  PortalEnvironment(const Params& p, float scale)
      : portal_(p), spectrum_(p.spectrum("L")), scale_(scale), directions_(weights(kEvenCells), kEvenCells) {
    flux_ = std::numbers::pi * photometric(*spectrum_);
  }
  PortalEnvironment(const Params& p, const Transform& world_from_light)
      : PortalEnvironment(p, world_from_light, read_square_image(p)) {}

  std::optional<LightSample> sample(const Vec3& p, Vec2 u, const SampledWavelengths& lambda) const override {
    const auto window = portal_.window_at(p);
    if (!window) return {};
    const auto s = directions_.sample(u, *window);
    if (!s) return {};
    const auto [w, steradians] = portal_.direction_of(s->uv);
    const float density = s->pdf / steradians;
    if (!(density > 0 && std::isfinite(density))) return {};
    return LightSample{at(s->uv, lambda), w, INFINITY, density};
  }
  SampledSpectrum radiance(const Vec3& from, const Vec3& direction, const SampledWavelengths& lambda) const override {
    const auto uv = portal_.square_of(direction);
    const auto window = uv ? portal_.window_at(from) : std::nullopt;
    return window && window->contains(*uv) ? at(*uv, lambda) : SampledSpectrum();
  }
  float pdf(const Vec3& from, const Vec3& direction) const override {
    float steradians = 0;
    const auto uv = portal_.square_of(direction, &steradians);
    const auto window = uv ? portal_.window_at(from) : std::nullopt;
    const float density = window ? directions_.pdf(*uv, *window) / steradians : 0;
    return density > 0 && std::isfinite(density) ? density : 0;
  }
  bool is_delta() const override { return false; }
  /// What comes through the portal hangs on the place.
  bool is_distant() const override { return false; }
  double power(float) const override { return double(scale_) * portal_.area() * flux_; }
  const Spectrum& emission() const override { return image_ ? *image_->white() : *spectrum_; }

 private:
  static constexpr int kEvenCells = 64;

  PortalEnvironment(const Params& p, const Transform& world_from_light, const ColorImage& file)
      : portal_(p),
        image_(rectified(file, world_from_light.inverse())),
        scale_(image_scale(p, file)),
        directions_(weights(image_->width()), image_->width()) {
    const int n = image_->width();
    for (int i = 0; i < n * n; ++i) {
      const auto [w, steradians] = portal_.direction_of(center(i, n));
      flux_ += double(image_->luminances()[size_t(i)] * steradians * portal_.cosine(w)) / (double(n) * n);
    }
  }

  static Vec2 center(int i, int n) { return {(float(i % n) + 0.5f) / float(n), (float(i / n) + 0.5f) / float(n)}; }

  /// The part of the image on the portal's side, by the portal's angles, as large as the image.
  LightImage rectified(const ColorImage& file, const Transform& light_from_world) const {
    const int n = file.image.width;
    Image result(n, n, {"R", "G", "B"});
    const auto texel = [&](int x, int y, size_t c) {
      if (x < 0 || x >= n) x = x < 0 ? -1 - x : 2 * n - 1 - x, y = n - 1 - y;
      if (y < 0 || y >= n) y = y < 0 ? -1 - y : 2 * n - 1 - y, x = n - 1 - x;
      return file.image.at(x, y, c);
    };
    for (int i = 0; i < n * n; ++i) {
      const Vec2 uv = square_from_sphere(normalize_any(light_from_world.vector(portal_.direction_of(center(i, n)).w)));
      const float x = uv.x * float(n) - 0.5f, y = uv.y * float(n) - 0.5f;
      const float x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
      const int a = int(x0), b = int(y0);
      for (size_t c = 0; c < 3; ++c)
        result.pixels[size_t(i) * 3 + c] = std::lerp(std::lerp(texel(a, b, c), texel(a + 1, b, c), fx),
                                                     std::lerp(texel(a, b + 1, c), texel(a + 1, b + 1, c), fx), fy);
    }
    return LightImage({std::move(result), file.space});
  }
  std::vector<float> weights(int n) const {
    std::vector<float> result;
    for (int i = 0; i < n * n; ++i)
      result.push_back(portal_.direction_of(center(i, n)).steradians * (image_ ? image_->luminances()[size_t(i)] : 1));
    return result;
  }
  SampledSpectrum at(Vec2 uv, const SampledWavelengths& lambda) const {
    return (image_ ? image_->nearest(uv, lambda) : spectrum_->sample(lambda)) * scale_;
  }

  Portal portal_;
  std::optional<LightImage> image_;
  SpectrumPtr spectrum_;
  float scale_;
  WindowedDistribution directions_;
  double flux_ = 0;  ///< of each unit of the portal's area
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
     .doc =
         "Illuminance of a surface under the upper half, in place of the radiance's own; an image gives twice as much, "
         "as in pbrt-v4."},
    {.name = "portal",
     .kind = ParamKind::point3,
     .doc = "Four corners in turn, in world space, of a rectangle that the light comes through.",
     .list = true},
};

std::unique_ptr<Light> make_infinite(const Params& p, const Transform& world_from_light) {
  const bool has_portal = p.given("portal");
  if (p.given("filename")) {
    if (p.given("L")) fail(p.where("L"), "\"L\" and \"filename\" exclude each other");
    if (has_portal) return std::make_unique<PortalEnvironment>(p, world_from_light);
    return std::make_unique<ImageEnvironment>(p, world_from_light);
  }
  const double scale =
      p.given("illuminance") ? p.real("scale") * p.real("illuminance") / std::numbers::pi : p.real("scale");
  if (has_portal) return std::make_unique<PortalEnvironment>(p, float(scale));
  return std::make_unique<ConstantEnvironment>(p, float(scale));
}

}  // namespace

extern const LightInfo infinite_light{
    {"light", "infinite", "Light from all around: the same everywhere, or an image.", "pbrt-v4", kInfinite},
    make_infinite};

}  // namespace frond
