#include <numbers>

#include "core/error.h"
#include "core/light.h"
#include "core/math/direction_map.h"
#include "core/math/distribution.h"
#include "core/math/equal_area.h"
#include "lights/light_params.h"
#include "lights/portal_light.h"
#include "lights/sphere_image.h"
#include "spectra/cie.h"

namespace frond {
namespace {

/// Uniform radiance from all directions.
class ConstantEnvironment final : public EnvironmentLight {
 public:
  explicit ConstantEnvironment(const Params& p, float scale) : spectrum_(p.spectrum("L")), scale_(scale) {}
  /// Samples the sphere uniformly.
  std::optional<LightSample> sample(const Vec3&, Vec2 u, const SampledWavelengths& lambda) const override {
    const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.f, 1 - z * z)), phi = 2 * kPi * u.y;
    return LightSample{
        spectrum_->sample(lambda) * scale_, {r * std::cos(phi), r * std::sin(phi), z}, INFINITY, kUniformPdf};
  }
  SampledSpectrum radiance(const Vec3&, const Vec3&, const SampledWavelengths& lambda) const override {
    return spectrum_->sample(lambda) * scale_;
  }
  float pdf(const Vec3&, const Vec3&) const override { return kUniformPdf; }
  /// BSDF samples are concentrated where a surface reflects the sky most; uniform light samples are not.
  double compensated_share() const override { return 0; }
  bool is_delta() const override { return false; }
  /// Power of the light that enters a sphere of the scene's radius.
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

/// A square image over the sphere in pbrt-v4's equal-area map, constant within each texel.
class ImageEnvironment final : public EnvironmentLight {
 public:
  ImageEnvironment(const Params& p, const Transform& world_from_light)
      : ImageEnvironment(p, world_from_light, read_sphere_image(p)) {}

  /// Samples texels by luminance.
  std::optional<LightSample> sample(const Vec3&, Vec2 u, const SampledWavelengths& lambda) const override {
    return sample_from(texels_by_power_, u, lambda);
  }
  /// Samples texels by luminance above the mean, for multiple importance sampling.
  std::optional<LightSample> sample_compensated(const Vec3&, Vec2 u, const SampledWavelengths& lambda) const override {
    return sample_from(texels_by_excess_, u, lambda);
  }
  /// Directions are mapped by the inverse of the light's transform.
  SampledSpectrum radiance(const Vec3&, const Vec3& direction, const SampledWavelengths& lambda) const override {
    return image_.nearest(to_square(direction), lambda) * scale_;
  }
  float pdf(const Vec3&, const Vec3& direction) const override { return density(texels_by_power_, direction); }
  float compensated_pdf(const Vec3&, const Vec3& direction) const override {
    return density(texels_by_excess_, direction);
  }
  double compensated_share() const override { return excess_share_; }
  bool is_delta() const override { return false; }
  /// Power of the light that enters a sphere of the scene's radius.
  double power(float radius) const override {
    constexpr double pi = std::numbers::pi;
    return 4 * pi * pi * double(radius) * double(radius) * double(scale_) * image_.mean_luminance();
  }
  const Spectrum& emission() const override { return *image_.white(); }

 private:
  static constexpr float kPerSphere = 0.25f * kInvPi;
  static constexpr double kLeastExcess = 0.01;  ///< images with less variation than this are left to BSDF sampling

  ImageEnvironment(const Params& p, const Transform& world_from_light, const ColorImage& file)
      : directions_(world_from_light),
        image_(file),
        scale_(sphere_image_scale(p, file)),
        texels_by_power_(image_.luminances(), image_.width()),
        texels_by_excess_(excesses(image_), image_.width()) {
    const double mean = image_.mean_luminance();
    if (!directions_.is_rotation())
      p.warn("filename", "the light's transform is not a rotation: it stretches the image over the sky");
    excess_share_ = mean > 0 ? mean_of(excesses(image_)) / mean : 1;
    if (excess_share_ < kLeastExcess) excess_share_ = 0;
  }

  /// Returns the part of each texel above the mean: BSDF samples cover the uniform part (Karlík et al. 2019, "MIS
  /// Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling").
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
  /// Returns nullopt if the sampled texel is black.
  std::optional<LightSample> sample_from(const Distribution2D& texels, Vec2 u, const SampledWavelengths& lambda) const {
    const auto [uv, density] = texels.sample(u);
    if (!(density > 0)) return {};
    const Vec3 w = sphere_from_square(uv);
    return LightSample{image_.nearest(uv, lambda) * scale_, directions_.to_world(w), INFINITY,
                       density * kPerSphere / directions_.solid_angle_factor(w)};
  }
  /// Density over solid angle: density over the square, over the solid angle of the square.
  float density(const Distribution2D& texels, const Vec3& direction) const {
    const Vec3 w = directions_.to_light(direction);
    return texels.pdf(square_from_sphere(w)) * kPerSphere / directions_.solid_angle_factor(w);
  }
  Vec2 to_square(const Vec3& direction) const { return square_from_sphere(directions_.to_light(direction)); }

  DirectionMap directions_;
  LightImage image_;
  float scale_;
  Distribution2D texels_by_power_, texels_by_excess_;
  double excess_share_ = 0;
};

constexpr Param kInfinite[] = {
    {.name = "L",
     .kind = ParamKind::illuminant,
     .default_value = std::array<double, 3>{1, 1, 1},
     .doc = "Radiance; spectra are normalised to luminance 1."},
    {.name = "filename",
     .kind = ParamKind::string,
     .doc = "Square image in pbrt-v4's equal-area map, instead of L. 8-bit files are decoded from sRGB; others "
            "are linear, in "
            "their own colour space, by default sRGB."},
    kLightScale,
    {.name = "illuminance",
     .kind = ParamKind::real,
     .unit = "lx",
     .doc = "Illuminance of a surface under the upper half, to which the light is scaled; 0 or less: not given. An "
            "image gives twice as much, as in pbrt-v4."},
    {.name = "portal",
     .kind = ParamKind::point3,
     .doc = "Corners, in cyclic order and in world space, of a rectangle through which the light enters.",
     .list = true},
};

std::unique_ptr<Light> make_infinite(const Params& p, const Transform& world_from_light) {
  if (p.given("filename") && p.given("L")) fail(p.where("L"), "\"L\" and \"filename\" exclude each other");
  if (p.given("portal")) return make_portal_light(p, world_from_light);
  if (p.given("filename")) return std::make_unique<ImageEnvironment>(p, world_from_light);
  return std::make_unique<ConstantEnvironment>(p, light_scale(p, "illuminance", std::numbers::pi));
}

}  // namespace

extern const LightInfo infinite_light{
    {"light", "infinite", "Environment light: uniform, or an image.", "pbrt-v4", kInfinite}, make_infinite};

}  // namespace frond
