#pragma once

#include <array>

#include "core/bsdf.h"
#include "core/math/sampling.h"

namespace frond {

/// Reflectance and transmittance of one side of a surface, lane by lane.
struct SideShares {
  SampledSpectrum reflected, transmitted;
};

/// Lambertian reflection and transmission with different shares for each side. Not reciprocal if the sides transmit
/// differently: the side of the incident direction decides.
class TwoSidedLambertianBsdf final : public Bsdf {
 public:
  /// Shares of light on the front (+z) and on the back; on each side their sum is at most 1.
  TwoSidedLambertianBsdf(const SideShares& front, const SideShares& back, bool from_light)
      : sides_{front, back}, from_light_(from_light) {
    for (const size_t side : {0u, 1u})
      chances_[side] = chances(sides_[side].reflected, sides_[from_light ? 1 - side : side].transmitted);
  }

  Lobes flags() const override {
    Lobes flags = from_light_ ? Lobes::diffuse | Lobes::from_light : Lobes::diffuse;
    if (chances_[0].reflect > 0 || chances_[1].reflect > 0) flags = flags | Lobes::reflection;
    if (chances_[0].transmit > 0 || chances_[1].transmit > 0) flags = flags | Lobes::transmission;
    return flags;
  }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    const float side = wo.z * wi.z;
    if (side == 0) return {};
    const SideShares& lit = sides_[side_of(from_light_ ? wi : wo)];
    return (side > 0 ? lit.reflected : lit.transmitted) * kInvPi;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float, Vec2 u, RandomStream& rng) const override {
    const float reflect = chances_[side_of(wo)].reflect;
    const bool reflects = u.x < reflect;
    u.x = reflects ? remap_sample(u.x, 0, reflect) : remap_sample(u.x, reflect, 1);
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
    const Chances& c = chances_[side_of(wo)];
    return (side > 0 ? c.reflect : c.transmit) * std::abs(wi.z) * kInvPi;
  }

 private:
  static size_t side_of(const Vec3& w) { return w.z < 0 ? 1 : 0; }

  /// Probabilities of a path that arrives on one side; both are stored, since 1 minus a tiny float is 1.
  struct Chances {
    float reflect, transmit;
  };
  /// In proportion to the means over the lanes.
  static Chances chances(const SampledSpectrum& reflected, const SampledSpectrum& transmitted) {
    const float r = sum(reflected), t = sum(transmitted);
    return r + t > 0 ? Chances{r / (r + t), t / (r + t)} : Chances{1, 0};
  }
  static float sum(const SampledSpectrum& s) { return s[0] + s[1] + s[2] + s[3]; }

  std::array<SideShares, 2> sides_;
  std::array<Chances, 2> chances_;
  bool from_light_;
};

}  // namespace frond
