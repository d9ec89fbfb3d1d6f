#include <numbers>

#include "core/error.h"
#include "core/sampling.h"
#include "scene/distribution.h"
#include "scene/registry.h"
#include "spectra/cie.h"

namespace frond {
namespace {

class ConstantEnvironment final : public EnvironmentLight {
 public:
  explicit ConstantEnvironment(const Params& p, float scale) : spectrum_(p.spectrum("L")), scale_(scale) {}
  std::optional<LightSample> sample(const Vec3&, Vec2 u, const SampledWavelengths& lambda) const override {
    const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.f, 1 - z * z)), phi = 2 * kPi * u.y;
    return LightSample{spectrum_->sample(lambda) * scale_, {r * std::cos(phi), r * std::sin(phi), z}, INFINITY, kUniformPdf};
  }
  SampledSpectrum radiance(const Vec3&, const SampledWavelengths& lambda) const override { return spectrum_->sample(lambda) * scale_; }
  float pdf(const Vec3&) const override { return kUniformPdf; }
  bool is_delta() const override { return false; }
  double power(float radius) const override {
    constexpr double pi = std::numbers::pi;
    return 4 * pi * pi * double(radius) * double(radius) * double(scale_) * photometric(*spectrum_);
  }
  Interval range_nm() const override { return spectrum_->range_nm(); }

 private:
  static constexpr float kUniformPdf = 0.25f * kInvPi;
  SpectrumPtr spectrum_;
  float scale_;
};

constexpr Param kInfinite[] = {
    {.name = "L", .kind = ParamKind::illuminant, .default_value = std::array<double, 3>{1, 1, 1}, .doc = "Radiance; spectra are normalised to luminance 1."},
    {.name = "scale", .kind = ParamKind::real, .default_value = 1.0, .range = kAtLeastZero, .doc = "Factor."},
    {.name = "illuminance", .kind = ParamKind::real, .unit = "lx", .range = kAtLeastZero, .doc = "Illuminance of a surface under the upper half, in place of the radiance's own."},
};

std::unique_ptr<Light> make_infinite(const Params& p, const Transform&) {
  const double scale = p.given("illuminance") ? p.real("scale") * p.real("illuminance") / std::numbers::pi : p.real("scale");
  return std::make_unique<ConstantEnvironment>(p, float(scale));
}

}  // namespace

extern const LightInfo infinite_light{{"light", "infinite", "Light from all around: the same everywhere, or an image.", "pbrt-v4", kInfinite}, make_infinite};

}  // namespace frond
