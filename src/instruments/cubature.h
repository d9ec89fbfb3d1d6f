#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/random.h"
#include "instruments/sphere.h"

namespace frond {

/// A function of direction, per sr.
using Density = std::function<double(const Vec3&)>;

/// A patch of the sphere and the integral of a density over it.
struct SpherePart {
  SphereBox box;
  double integral = 0;
};

/// Integrates by adaptive Gauss quadrature, and returns the parts that it cut the box into. These are cut until cutting
/// changes them by no more than `tolerance` and a 10,000th of their value. `peaks`: directions where the density may be
/// large, so that no narrow lobe slips through the nodes.
std::vector<SpherePart> integrate(const SphereBox& box, const Density& density, double tolerance,
                                  std::span<const SpherePoint> peaks = {});

double total(std::span<const SpherePart> parts);

/// Draws directions in parts, half of them in proportion to the integral and half to the solid angle: for Monte Carlo
/// integration of something that is large about where the integrated density is.
class PartSampler {
 public:
  struct Draw {
    Vec3 w;
    double density;  ///< of this draw, per sr
  };
  explicit PartSampler(std::vector<SpherePart> parts);
  Draw draw(RandomStream& numbers) const;

 private:
  std::vector<SpherePart> parts_;
  std::vector<double> cumulative_;  ///< probability of this part and those before
};

}  // namespace frond
