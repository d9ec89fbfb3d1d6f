#pragma once

#include <optional>
#include <vector>

#include "core/material.h"

namespace frond {

/// Line segment, in world space.
struct Segment {
  Vec3 from, to;
};

/// Separable BSSRDF at a point `po` of a surface, where a path enters the material (Jensen et al. 2001; pbrt 4th ed.):
///
///   S(po, wo, pi, wi) = (1 - F(wo)) Sp(|po - pi|) Sw(wi)
///
/// The first factor is the transmission that the material's BSDF samples at `po`. Sp is the profile, per area. Sw is a
/// BSDF, with the factor n^2 that refraction into the medium took from the radiance.
///
/// A path continues at a point `pi` that it finds by intersecting a segment with the surfaces of the same material: of
/// n intersections it takes one, each with the probability 1 / n, and multiplies its throughput by n `weight(pi)` (King
/// et al. 2013, "BSSRDF importance sampling"). All lanes share the point; densities are means over the lanes for which
/// the segment may have been sampled, so that the estimate of each lane is unbiased (balance heuristic).
class Bssrdf {
 public:
  /// Samples a segment for `uc` and `u` in [0, 1); empty if the path ends.
  virtual std::optional<Segment> sample(float uc, Vec2 u) const = 0;
  /// Sp over the density per area, lane by lane, at an intersection of a segment; 0 in lanes that are not active.
  virtual SampledSpectrum weight(const Hit& pi) const = 0;
  /// Sw, for wo = +z of the shading frame at `pi`.
  virtual const Bsdf& exit() const = 0;

 protected:
  ~Bssrdf() = default;  // lives in an arena and is never deleted
};

/// Base of the materials with a BSSRDF, beside Material; asked for by dynamic_cast, before the first path. Their BSDF
/// is the interface alone: light that it transmits from the front into the material continues by the BSSRDF. From the
/// back it is refracted out, without scattering.
class SubsurfaceMaterial {
 public:
  virtual ~SubsurfaceMaterial() = default;
  /// Returns the BSSRDF at a hit, allocated in `arena`. Thread-safe.
  virtual const Bssrdf& bssrdf(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const = 0;
};

/// By SurfacePoint::material_id; nullptr: the material has no BSSRDF. Empty if none has.
using SubsurfaceMaterials = std::vector<const SubsurfaceMaterial*>;

/// Base of the integrators whose paths follow BSSRDFs, beside Integrator; scenes with such materials need one.
class SubsurfaceIntegrator {
 public:
  virtual ~SubsurfaceIntegrator() = default;
  /// Called once, before Integrator::prepare, if a material of the scene has a BSSRDF.
  virtual void set_subsurface(SubsurfaceMaterials by_material) = 0;
};

}  // namespace frond
