#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/material.h"

/// The calls that a renderer makes of a BSDF, with realistic arguments, for benchmarks.
namespace frond {

/// Returns the wavelengths (nm) of a benchmark with 1 to kLanes lanes.
std::vector<float> benchmark_wavelengths(int lanes);

/// Returns the unit vector at theta_deg degrees from the front's normal, azimuth 0.
Vec3 view_direction(double theta_deg);

/// Arguments that vary from call to call: drawn in advance and reused cyclically.
class CallDraws {
 public:
  /// Arguments of one call.
  struct Draw {
    Vec3 wi;  ///< uniform over the sphere
    Vec3 wo;  ///< on either side, cosine-weighted
    float uc;
    Vec2 u;
  };

  CallDraws();
  const Draw& next() { return draws_[i_++ % draws_.size()]; }

 private:
  std::array<Draw, 1024> draws_;
  size_t i_ = 0;
};

/// Results of a BSDF at one vertex of a path.
struct PathVertex {
  SampledSpectrum f_cos;   ///< f |cos theta| toward the light's sample, 1/sr; 0 where `light_pdf` is
  float light_pdf = 0;     ///< of the BSDF for the light's sample, 1/sr
  SampledSpectrum weight;  ///< of the scattered ray: f |cos theta| / pdf; 0 where nothing is scattered
  Vec3 wi;                 ///< direction of the scattered ray
  float pdf = 0;           ///< of the BSDF for it, 1/sr, as MIS uses it; infinite for a delta lobe
};

/// Calls a BSDF as the path integrator does at each vertex: density and value toward a light sample, then a scattered
/// ray, and its density if the sample's own is approximate.
inline PathVertex path_vertex(const Bsdf& bsdf, const Vec3& wo, const Vec3& toward_light, float uc, Vec2 u,
                              RandomStream& rng) {
  PathVertex vertex;
  vertex.light_pdf = bsdf.pdf(wo, toward_light);
  if (vertex.light_pdf > 0) vertex.f_cos = bsdf.f(wo, toward_light, rng) * std::abs(toward_light.z);
  const std::optional<BsdfSample> s = bsdf.sample(wo, uc, u, rng);
  if (!s) return vertex;
  vertex.weight = s->f * (std::abs(s->wi.z) / s->pdf);
  vertex.wi = s->wi;
  vertex.pdf = s->pdf_is_approximate ? bsdf.pdf(wo, s->wi) : s->pdf;
  if (any(s->flags & Lobes::specular)) vertex.pdf = INFINITY;
  return vertex;
}

}  // namespace frond
