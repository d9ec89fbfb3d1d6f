#pragma once

#include "core/bsdf.h"
#include "materials/lobes/dielectric_interface.h"

namespace frond {

/// Complex index of refraction eta + i k of an absorbing medium, over the index of the medium before it; lane by lane.
struct ConductorIndices {
  SampledSpectrum eta, k;

  /// Clamped, so that fourth powers stay finite in float.
  ConductorIndices(const SampledSpectrum& eta_, const SampledSpectrum& k_) : eta(bounded(eta_)), k(bounded(k_)) {}

  /// Returns eta = 1 and the k that gives this reflectance at normal incidence, clamped to [0, 0.9999].
  static ConductorIndices of_reflectance(const SampledSpectrum& r_) {
    const Float4 r = r_.v < 0.9999f ? larger(r_.v, Float4{}) : Float4{0.9999f, 0.9999f, 0.9999f, 0.9999f};
    return {SampledSpectrum(1), SampledSpectrum(2 * square_root(r / (1 - r)))};
  }

 private:
  static SampledSpectrum bounded(const SampledSpectrum& s) {
    constexpr Float4 kMost{1e4f, 1e4f, 1e4f, 1e4f};
    return SampledSpectrum(s.v < kMost ? s.v : kMost);
  }
};

/// A metal, smooth or rough, the same on both sides: Trowbridge-Reitz facets with Fresnel reflectance. The rest of the
/// light is absorbed.
class ConductorBsdf final : public Bsdf {
 public:
  /// `mask`: 1 in active lanes, 0 elsewhere.
  ConductorBsdf(const TrowbridgeReitz& facets, const ConductorIndices& indices, const SampledSpectrum& mask)
      : facets_(facets), indices_(indices), mask_(mask) {}

  bool is_smooth() const { return facets_.is_smooth(); }
  ConductorBsdf regularized() const { return {facets_.regularized(), indices_, mask_}; }
  const Bsdf* regularized(Arena& arena) const override { return arena.make<ConductorBsdf>(regularized()); }
  Lobes flags() const override { return Lobes::reflection | (is_smooth() ? Lobes::specular : Lobes::glossy); }

  SampledSpectrum f(const Vec3& wo_, const Vec3& wi_, RandomStream&) const override { return f(wo_, wi_); }
  /// f and sample without a random stream, for LayeredBsdf.
  SampledSpectrum f(const Vec3& wo_, const Vec3& wi_) const {
    if (!scatters(wo_, wi_)) return {};
    const Vec3 wo = to_upper_side(wo_), wi = to_upper_side(wi_), m = normalize_any(wo + wi);
    return fresnel(dot(wo, m)) * (facets_.density(m) * facets_.smith_visibility(wo, wi));
  }

  float pdf(const Vec3& wo_, const Vec3& wi_) const override {
    if (!scatters(wo_, wi_)) return 0;
    const Vec3 wo = to_upper_side(wo_), wi = to_upper_side(wi_);
    return facets_.density(normalize_any(wo + wi)) * facets_.g1_over_cosine(wo) / 4;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float, Vec2 u, RandomStream&) const override {
    return sample(wo, u);
  }
  std::optional<BsdfSample> sample(const Vec3& wo, Vec2 u) const {
    if (is_grazing(wo)) return {};
    if (is_smooth()) {
      const float cosine = std::abs(wo.z);
      return BsdfSample{fresnel(cosine) * (1 / cosine), {-wo.x, -wo.y, wo.z}, 1, flags()};
    }
    const Vec3 up = to_upper_side(wo), m = facets_.sample_visible(up, u);
    Vec3 wi = 2 * dot(up, m) * m - up;
    if (!(wi.z > 0)) return {};
    if (wo.z < 0) wi.z = -wi.z;
    const float density = pdf(wo, wi);
    if (!(density > 0)) return {};
    return BsdfSample{f(wo, wi), wi, density, flags()};
  }

 private:
  bool scatters(const Vec3& wo, const Vec3& wi) const {
    return !is_smooth() && same_side(wo, wi) && !is_grazing(wo) && !is_grazing(wi);
  }
  static Vec3 to_upper_side(const Vec3& w) { return {w.x, w.y, std::abs(w.z)}; }
  SampledSpectrum fresnel(float cosine) const { return fresnel_conductor(cosine, indices_.eta, indices_.k) * mask_; }

  TrowbridgeReitz facets_;
  ConductorIndices indices_;
  SampledSpectrum mask_;
};

}  // namespace frond
