#pragma once

#include "core/bsdf.h"
#include "core/math/sampling.h"

namespace frond {

/// Lambertian reflection and transmission, the same on both sides (Lambert 1760). f = reflectance / pi or transmittance
/// / pi.
class LambertianBsdf final : public Bsdf {
 public:
  /// Both in [0, 1], their sum at most 1 in each lane.
  LambertianBsdf(const SampledSpectrum& reflectance, const SampledSpectrum& transmittance)
      : reflectance_(reflectance), transmittance_(transmittance) {
    const float r = reflectance.max(), t = transmittance.max();
    reflect_ = r + t > 0 ? r / (r + t) : 1;
  }

  Lobes flags() const override {
    Lobes flags = Lobes::diffuse;
    if (reflect_ > 0) flags = flags | Lobes::reflection;
    if (reflect_ < 1) flags = flags | Lobes::transmission;
    return flags;
  }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    const float side = wo.z * wi.z;
    if (side == 0) return {};
    return (side > 0 ? reflectance_ : transmittance_) * kInvPi;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float, Vec2 u, RandomStream& rng) const override {
    const bool reflects = u.x < reflect_;
    u.x = reflects ? remap_sample(u.x, 0, reflect_) : remap_sample(u.x, reflect_, 1);
    Vec3 wi = sample_cosine_hemisphere(u);
    if ((wo.z < 0) == reflects) wi.z = -wi.z;
    const float density = pdf(wo, wi);
    if (density == 0) return {};
    return BsdfSample{f(wo, wi, rng), wi, density,
                      Lobes::diffuse | (reflects ? Lobes::reflection : Lobes::transmission)};
  }

  float pdf(const Vec3& wo, const Vec3& wi) const override {
    const float side = wo.z * wi.z;
    if (side == 0) return 0;
    return (side > 0 ? reflect_ : 1 - reflect_) * std::abs(wi.z) * kInvPi;
  }

 private:
  SampledSpectrum reflectance_, transmittance_;
  float reflect_;  ///< probability of reflection
};

}  // namespace frond
