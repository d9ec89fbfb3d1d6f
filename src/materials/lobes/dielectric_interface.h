#pragma once

#include <optional>

#include "materials/lobes/fresnel.h"
#include "materials/lobes/trowbridge_reitz.h"

namespace frond {

/// Whether a direction is so close to the surface that f is taken as 0, which avoids division by tiny cosines.
inline bool is_grazing(const Vec3& w) { return std::abs(w.z) < 1e-15f; }

/// Interface between two dielectrics at one wavelength, smooth or rough (Walter et al. 2007). Directions and f as in a
/// Bsdf, for radiance.
class DielectricInterface {
 public:
  /// `eta`: index of refraction below over that above.
  DielectricInterface(const TrowbridgeReitz& facets, float eta) : facets_(facets), eta_(eta) {}

  bool is_smooth() const { return facets_.is_smooth(); }
  const TrowbridgeReitz& facets() const { return facets_; }
  /// Index of refraction on the far side of `w`, over that on its own side.
  float eta_beyond(const Vec3& w) const { return w.z > 0 ? eta_ : 1 / eta_; }

  /// Terms of a rough interface for the facets that scatter wo into wi: f without Fresnel's factor, the density of `wi`
  /// given that the ray is reflected (or refracted), and Fresnel's reflectance.
  struct Pair {
    float f = 0, pdf = 0, fresnel = 0;
    /// Reflectance or transmittance of the facet.
    float share(bool reflects) const { return reflects ? fresnel : 1 - fresnel; }
  };
  Pair pair(Vec3 wo, Vec3 wi) const {
    if (is_grazing(wo) || is_grazing(wi)) return {};
    const float eta = eta_beyond(wo);
    if (wo.z < 0) wo.z = -wo.z, wi.z = -wi.z;
    return wi.z > 0 ? reflected(wo, wi, eta) : refracted(wo, wi, eta);
  }

  /// A sampled direction, given that the ray is reflected (or refracted).
  struct Way {
    Vec3 wi;
    float weight;  ///< f |cos theta_i| / pdf
    float pdf;     ///< 1/sr, given the branch; 1 if smooth
  };

  /// Draws the normal of a facet visible from wo; +z if smooth.
  Vec3 facet(const Vec3& wo, Vec2 u) const {
    if (is_smooth()) return {0, 0, 1};
    return facets_.sample_visible({wo.x, wo.y, std::abs(wo.z)}, u);
  }
  /// Reflectance of a facet of normal `m`.
  float fresnel(const Vec3& wo, const Vec3& m) const {
    return fresnel_dielectric(dot({wo.x, wo.y, std::abs(wo.z)}, m), eta_beyond(wo));
  }

  /// Reflects wo by a facet; nothing if the result is below the surface.
  std::optional<Way> reflect(const Vec3& wo_, const Vec3& m) const {
    const Vec3 wo{wo_.x, wo_.y, std::abs(wo_.z)};
    const float cosine = dot(wo, m), share = fresnel_dielectric(cosine, eta_beyond(wo_));
    Vec3 wi = 2 * cosine * m - wo;
    if (!(wi.z > 0)) return {};
    Way way{wi, share, 1};
    if (!is_smooth()) {
      way.pdf = facets_.density(m) * facets_.g1_over_cosine(wo) / 4;
      way.weight *= g2_over_g1(wo, wi);
    }
    if (wo_.z < 0) way.wi.z = -way.wi.z;
    return way;
  }

  /// Refracts wo by a facet; nothing under total reflection or if the result is above the surface.
  std::optional<Way> refract(const Vec3& wo_, const Vec3& m) const {
    const float eta = eta_beyond(wo_);
    const Vec3 wo{wo_.x, wo_.y, std::abs(wo_.z)};
    const float cosine = dot(wo, m), cosine2_beyond = 1 - std::max(0.f, 1 - cosine * cosine) / (eta * eta);
    if (cosine2_beyond <= 0) return {};
    const float cosine_beyond = std::sqrt(cosine2_beyond);
    const Vec3 wi = normalize(wo * (-1 / eta) + m * (cosine / eta - cosine_beyond));
    if (!(wi.z < 0)) return {};
    Way way{wi, (1 - fresnel_dielectric(cosine, eta)) / (eta * eta), 1};
    if (!is_smooth()) {
      way.pdf =
          facets_.density(m) * facets_.g1_over_cosine(wo) * cosine * refraction_jacobian(cosine, cosine_beyond, eta);
      way.weight *= g2_over_g1(wo, {wi.x, wi.y, -wi.z});
    }
    if (wo_.z < 0) way.wi.z = -way.wi.z;
    return way;
  }

 private:
  Pair reflected(const Vec3& wo, const Vec3& wi, float eta) const {
    const Vec3 m = normalize_any(wo + wi);
    const float area = facets_.density(m);
    return {area * facets_.smith_visibility(wo, wi), area * facets_.g1_over_cosine(wo) / 4,
            fresnel_dielectric(dot(wo, m), eta)};
  }

  Pair refracted(const Vec3& wo, const Vec3& wi, float eta) const {
    // In double, so that f is reciprocal even if a cosine is small.
    Vec3d m = normalize_any(to_double(wo) + double(eta) * to_double(wi));
    if (m.z < 0) m = -m;
    const float cosine = float(dot(to_double(wo), m)), beyond = float(-dot(to_double(wi), m));
    if (cosine <= 0 || beyond <= 0) return {};
    const float area = facets_.density(to_float(m)) * cosine * refraction_jacobian(cosine, beyond, eta);
    return {area * 4 * facets_.smith_visibility(wo, {wi.x, wi.y, -wi.z}) / (eta * eta),
            area * facets_.g1_over_cosine(wo), fresnel_between(cosine, beyond, eta)};
  }

  /// Jacobian of refraction: solid angle of facet normals over solid angle of refracted directions (Walter et al.
  /// 2007); cosines of both directions to the facet.
  static float refraction_jacobian(float cosine, float beyond, float eta) {
    const float whole = cosine / eta - beyond;
    return beyond / (whole * whole);
  }

  /// Share of the facets visible from wo that are visible from wi too: G2 / G1.
  float g2_over_g1(const Vec3& wo, const Vec3& wi) const {
    return 4 * wi.z * facets_.smith_visibility(wo, wi) / facets_.g1_over_cosine(wo);
  }

  TrowbridgeReitz facets_;
  float eta_;
};

}  // namespace frond
