#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/vec.h"

namespace frond {

/// A patch of the unit sphere: cos theta in [z0, z1), phi in [phi0, phi1).
struct SphereBox {
  double z0 = -1, z1 = 1, phi0 = 0, phi1 = 6.283185307179586;

  /// Solid angle, sr.
  double solid_angle() const { return (z1 - z0) * (phi1 - phi0); }
  /// Area-preserving map of the unit square.
  Vec3 at(double u, double v) const;
};

/// A function of direction, per sr.
using Density = std::function<double(const Vec3&)>;

/// Unit vector from cos theta and azimuth (radians).
Vec3 sphere_direction(double cos_theta, double phi);

/// The whole sphere cut into patches that hold about as many of some directions each, and none of which reaches across
/// the horizon or is larger than 1/16 of the sphere. So a narrow lobe gets narrow patches.
class SphereBins {
 public:
  /// `bins`: how many there should be, about.
  SphereBins(std::span<const Vec3> directions, int bins);

  size_t size() const { return boxes_.size(); }
  const SphereBox& box(size_t bin) const { return boxes_[bin]; }
  /// Integral over a bin of a density that is large where the directions lie. The bin is first cut between these, so
  /// that no lobe slips through the quadrature's nodes.
  double integral(size_t bin, const Density& density, double tolerance) const;
  size_t find(const Vec3& w) const;

 private:
  struct Point {
    double z, phi;
  };
  struct Node {
    bool by_phi = false;
    double split = 0;
    size_t below = 0, above = 0;  ///< nodes; in a leaf, `below` is the bin
    bool leaf = false;
  };
  struct Cut {
    bool by_phi;
    double at = 0;
    SphereBox below = {}, above = {};
    std::span<Point> points_below = {}, points_above = {};
  };
  static Point point(const Vec3& w);
  static Cut cut(const SphereBox& box, std::span<Point> points, int depth);
  size_t build(const SphereBox& box, std::span<Point> points, int depth);
  void cut_into_cells(const SphereBox& box, std::span<Point> points, int depth);

  size_t largest_count_;
  std::vector<SphereBox> boxes_;
  std::vector<SphereBox> cells_;     ///< parts of the bins, bin after bin
  std::vector<size_t> cells_begin_;  ///< of each bin
  std::vector<Node> nodes_;
  size_t root_;
};

/// Integral over a patch by adaptive Gauss quadrature. Parts are cut until cutting them changes them by no more than
/// `tolerance` and a 10,000th of their value.
double integrate(const SphereBox& box, const Density& density, double tolerance);

}  // namespace frond
