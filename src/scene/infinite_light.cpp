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

}  // namespace
}  // namespace frond
