#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/math/random.h"
#include "instruments/sphere.h"

namespace frond {

/// Function of direction, 1/sr.
using Density = std::function<double(const Vec3&)>;

/// A patch of the sphere and the integral of a density over it.
struct SpherePart {
  SphereBox box;
  double integral = 0;
  double largest = 0;  ///< largest density found at the nodes
  /// 0 if division has settled the integral; else, at the limit of division, the largest density of a node or peak
  /// times the solid angle.
  double error = 0;

  /// Whether the nodes have missed a lobe that has this density.
  bool misses_lobe(double density) const { return density > 3 * largest; }
};

/// Integrates by adaptive Gauss quadrature; returns the parts into which it has divided the box. A part is divided
/// until division changes its integral by at most `tolerance` plus a 10,000th of its value. `peaks`: directions where
/// the density may be large, so that no narrow lobe is missed between nodes.
std::vector<SpherePart> integrate(const SphereBox& box, const Density& density, double tolerance,
                                  std::span<const SpherePoint> peaks = {});

/// Sum of the integrals.
double total(std::span<const SpherePart> parts);
/// Sum of the errors.
double total_error(std::span<const SpherePart> parts);

/// Draws directions in parts, half of them in proportion to the integral and half to the solid angle: importance
/// sampling for functions similar to the integrated density.
class PartSampler {
 public:
  /// A unit vector and its density.
  struct Draw {
    Vec3 w;
    double density;  ///< of this draw, 1/sr
  };
  /// At least one part.
  explicit PartSampler(std::vector<SpherePart> parts);
  std::span<const SpherePart> parts() const { return parts_; }
  Draw draw(RandomStream& numbers) const;

 private:
  std::vector<SpherePart> parts_;
  std::vector<double> cumulative_;  ///< probability of all parts up to this one
};

}  // namespace frond
