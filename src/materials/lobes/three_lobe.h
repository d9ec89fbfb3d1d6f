#pragma once

#include <limits>

#include "core/bsdf.h"
#include "core/sampling.h"
#include "leaf/lobe.h"
#include "leaf/lookup.h"
#include "materials/lobes/active_lanes.h"

namespace frond {

/// A leaf as three lobes, each scaled by its share of the light (Baranoski and Rokne): the mirror direction spread by a
/// power of the cosine (Rs), a cosine lobe on the side of incidence (Rd) and one on the other side (T).
class ThreeLobeBsdf final : public Bsdf {
 public:
  /// Everything given outlives the BSDF. surface_direct false: `f` and `pdf` leave the surface lobe out, and `sample`
  /// returns it as if it were a delta lobe, so that light sampling never sees it.
  ThreeLobeBsdf(const leaf::TableLookup& shares, const leaf::Lobe& surface, const SampledWavelengths& lambda,
                bool surface_direct)
      : table_(shares),
        surface_(surface),
        lambda_(lambda),
        active_(lane_mask(lambda)),
        surface_direct_(surface_direct) {}

  Lobes flags() const override {
    const Lobes surface = Lobes::surface | (surface_direct_ ? Lobes::glossy : Lobes::glossy | Lobes::specular);
    return Lobes::reflection | Lobes::transmission | Lobes::diffuse | surface;
  }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    return scatters(wo, wi) ? at(wo, wi).f : SampledSpectrum();
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    if (wo.z == 0) return {};
    const Incidence& in = at(wo);
    if (uc < in.surface) return sample_surface(in, wo, u, rng);
    Vec3 wi = sample_cosine_hemisphere(u);
    const bool reflects = uc < in.surface + in.subsurface;
    if ((wo.z < 0) == reflects) wi.z = -wi.z;
    if (!scatters(wo, wi)) return {};
    const Value value = at(wo, wi);
    if (value.pdf == 0) return {};  // black
    return BsdfSample{value.f, wi, value.pdf, Lobes::diffuse | (reflects ? Lobes::reflection : Lobes::transmission)};
  }

  float pdf(const Vec3& wo, const Vec3& wi) const override { return scatters(wo, wi) ? at(wo, wi).pdf : 0; }

 private:
  /// What depends on wo alone.
  struct Incidence {
    float cos_theta = std::numeric_limits<float>::quiet_NaN();
    float surface, subsurface, transmitted;  ///< probabilities of the lobes
    float scale;                             ///< of the surface lobe's density, for what the cut leaves
    leaf::SampledShares shares;              ///< 0 in lanes that are not active
  };

  struct Value {
    SampledSpectrum f;
    float pdf;
  };

  static bool scatters(const Vec3& wo, const Vec3& wi) {
    constexpr float kLeastCosine = 1e-20f;  // closer to the surface's plane than floats should be divided by
    return wo.z != 0 && std::abs(wi.z) >= kLeastCosine;
  }

  /// f, pdf and sample come in turn for one wo: looked up once.
  const Incidence& at(const Vec3& wo) const {
    if (incidence_.cos_theta == wo.z) return incidence_;
    Incidence& in = incidence_;
    in.cos_theta = wo.z;
    in.shares = table_(wo.z, lambda_);
    in.shares.surface *= active_;
    in.shares.subsurface *= active_;
    in.shares.transmitted *= active_;
    const auto sum = [](const SampledSpectrum& s) { return s[0] + s[1] + s[2] + s[3]; };
    const float surface = sum(in.shares.surface), subsurface = sum(in.shares.subsurface);
    const float transmitted = sum(in.shares.transmitted), all = surface + subsurface + transmitted;
    const float norm = all > 0 ? 1 / all : 0;
    in.surface = surface * norm;
    in.subsurface = subsurface * norm;
    in.transmitted = transmitted * norm;
    in.scale = static_cast<float>(1 / surface_.kept(std::abs(wo.z)));
    return in;
  }

  /// Where wi scatters.
  Value at(const Vec3& wo, const Vec3& wi) const {
    const Incidence& in = at(wo);
    const float cos_theta_i = std::abs(wi.z), cosine = cos_theta_i * kInvPi;
    if (!same_side(wo, wi)) return {in.shares.transmitted * kInvPi, in.transmitted * cosine};
    Value value{in.shares.subsurface * kInvPi, in.subsurface * cosine};
    if (!surface_direct_) return value;
    const float density = in.scale * static_cast<float>(surface_.density(dot(mirror(wo), wi)));
    value.f += in.shares.surface * (density / cos_theta_i);
    value.pdf += in.surface * density;
    return value;
  }

  static Vec3 mirror(const Vec3& wo) { return {-wo.x, -wo.y, wo.z}; }

  std::optional<BsdfSample> sample_surface(const Incidence& in, const Vec3& wo, Vec2 u, RandomStream& rng) const {
    const Frame frame = Frame::around(mirror(wo));
    for (;; u = {rng.uniform(), rng.uniform()}) {
      const Vec2 disk = sample_disk(u);
      const float r2 = disk.x * disk.x + disk.y * disk.y;
      if (r2 == 0) continue;
      const float cos_alpha = surface_.cos_from_uniform(1 - r2);
      const float s = std::sqrt(std::max(0.f, 1 - cos_alpha * cos_alpha) / r2);
      const Vec3 wi = normalize(frame.to_world({s * disk.x, s * disk.y, cos_alpha}));
      if (!same_side(wo, wi) || !scatters(wo, wi)) continue;
      const BsdfSample sample = surface_sample(in, wo, wi);
      if (sample.pdf > 0) return sample;  // not on the lobe's very edge
    }
  }

  BsdfSample surface_sample(const Incidence& in, const Vec3& wo, const Vec3& wi) const {
    const Lobes lobe = Lobes::reflection | Lobes::glossy | Lobes::surface;
    if (!surface_direct_) return {in.shares.surface * (1 / std::abs(wi.z)), wi, in.surface, lobe | Lobes::specular};
    const Value value = at(wo, wi);
    return {value.f, wi, value.pdf, lobe};
  }

  const leaf::TableLookup& table_;
  const leaf::Lobe& surface_;
  SampledWavelengths lambda_;
  SampledSpectrum active_;
  bool surface_direct_;
  mutable Incidence incidence_;
};

}  // namespace frond
