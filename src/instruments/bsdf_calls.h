#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/material.h"

/// The calls that a renderer makes of a BSDF, and what it hands over: for those who time them.
namespace frond {

/// Wavelengths (nm) of a benchmark with so many lanes, 1 to kLanes.
std::vector<float> benchmark_wavelengths(int lanes);

/// Unit vector at so many degrees from the front's normal, azimuth 0.
Vec3 viewer_at(double theta_deg);

/// What varies from call to call, drawn beforehand; the same ones again and again.
class CallDraws {
 public:
  struct Draw {
    Vec3 wi;  ///< uniform over the sphere
    Vec3 wo;  ///< on either side, by its cosine
    float uc;
    Vec2 u;
  };

  CallDraws();
  const Draw& next() { return draws_[i_++ % draws_.size()]; }

 private:
  std::array<Draw, 1024> draws_;
  size_t i_ = 0;
};

/// What one vertex of a path learns from its BSDF.
struct PathVertex {
  SampledSpectrum f_cos;   ///< f |cos theta| toward the light's sample, 1/sr; 0 where `light_pdf` is
  float light_pdf = 0;     ///< of the BSDF for the light's sample, 1/sr
  SampledSpectrum weight;  ///< of the scattered ray: f |cos theta| / pdf; 0 where nothing is scattered
  Vec3 wi;                 ///< its direction
  float pdf = 0;           ///< of the BSDF for it, 1/sr, as MIS asks; infinite for a delta lobe
};

/// Asks a BSDF as the path integrator does at each vertex: its density and value toward a sample of a light, then a
/// scattered ray, and its density where the sample's own is approximate.
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
