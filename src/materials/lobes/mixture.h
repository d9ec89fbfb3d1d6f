#pragma once

#include "core/bsdf.h"
#include "materials/lobes/active_lanes.h"

namespace frond {

/// Transmits all light without a change of direction: an invisible surface.
class PassThroughBsdf final : public Bsdf {
 public:
  explicit PassThroughBsdf(const SampledWavelengths& lambda) : share_(lane_mask(lambda)) {}

  Lobes flags() const override { return Lobes::specular | Lobes::transmission; }
  SampledSpectrum f(const Vec3&, const Vec3&, RandomStream&) const override { return {}; }
  std::optional<BsdfSample> sample(const Vec3& wo, float, Vec2, RandomStream&) const override {
    if (wo.z == 0) return {};
    return BsdfSample{share_ * (1 / std::abs(wo.z)), -wo, 1, flags()};
  }
  float pdf(const Vec3&, const Vec3&) const override { return 0; }

 private:
  SampledSpectrum share_;
};

/// Linear combination of two BSDFs, the second with share `amount`, the first with the rest; evaluated exactly, not by
/// a random choice at each hit.
class MixtureBsdf final : public Bsdf {
 public:
  MixtureBsdf(const Bsdf& first, const Bsdf& second, float amount)
      : first_(first), second_(second), amount_(amount), stochastic_(any(flags() & Lobes::stochastic)) {}

  Lobes flags() const override { return first_.flags() | second_.flags(); }
  const Bsdf* regularized(Arena& arena) const override {
    return arena.make<MixtureBsdf>(*first_.regularized(arena), *second_.regularized(arena), amount_);
  }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream& rng) const override {
    return (1 - amount_) * first_.f(wo, wi, rng) + amount_ * second_.f(wo, wi, rng);
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    const bool takes_second = uc < amount_;
    const float share = takes_second ? amount_ : 1 - amount_;
    constexpr float kBelowOne = 0x1.fffffep-1f;
    const float rest = std::min((takes_second ? uc : uc - amount_) / share, kBelowOne);
    auto s = (takes_second ? second_ : first_).sample(wo, rest, u, rng);
    if (!s) return s;
    if (stochastic_ || s->pdf_is_approximate || any(s->flags & Lobes::specular)) {
      // Drawn with probability `share`: the weight f / pdf of the drawn BSDF is unchanged.
      s->f *= share;
      s->pdf *= share;
      s->pdf_is_approximate = stochastic_ || s->pdf_is_approximate;
    } else {
      s->f = f(wo, s->wi, rng);
      s->pdf = pdf(wo, s->wi);
    }
    return s;
  }

  float pdf(const Vec3& wo, const Vec3& wi) const override {
    return (1 - amount_) * first_.pdf(wo, wi) + amount_ * second_.pdf(wo, wi);
  }

  /// Index of the transmitting BSDF. If both transmit with different indices the mixture has none.
  SampledSpectrum index_ratio() const override {
    return any(first_.flags() & Lobes::transmission) ? first_.index_ratio() : second_.index_ratio();
  }

  /// Per ray, since the two may use different incident directions.
  void scatter(const Vec3& incident, RandomStream& rng, std::span<Scattered> rays) const override {
    for (size_t i = 0; i < rays.size(); ++i)
      (rng.uniform() < amount_ ? second_ : first_).scatter(incident, rng, rays.subspan(i, 1));
  }

 private:
  const Bsdf& first_;
  const Bsdf& second_;
  float amount_;
  bool stochastic_;
};

}  // namespace frond
