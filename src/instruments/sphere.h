#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace frond {

/// A direction and its coordinates.
struct SpherePoint {
  double cos_theta, phi;  ///< phi in [0, 2 pi)
  Vec3 w;

  /// From a unit vector.
  explicit SpherePoint(const Vec3& direction);
};

/// Unit vector from cos theta and azimuth (radians).
Vec3 sphere_direction(double cos_theta, double phi);

/// A patch of the unit sphere: cos theta in [z0, z1), phi in [phi0, phi1).
struct SphereBox {
  double z0 = -1, z1 = 1, phi0 = 0, phi1 = 6.283185307179586;

  /// Solid angle, sr.
  double solid_angle() const { return (z1 - z0) * (phi1 - phi0); }
  bool contains(double cos_theta, double phi) const {
    return cos_theta >= z0 && cos_theta < z1 && phi >= phi0 && phi < phi1;
  }
  /// Area-preserving map of the unit square into the box.
  Vec3 at(double u, double v) const;
};

/// Partition of the sphere into patches that contain about equally many of some directions; none crosses the horizon or
/// is larger than 1/16 of the sphere. A narrow lobe therefore has narrow patches.
class SphereBins {
 public:
  /// `bins`: approximate number of patches.
  SphereBins(std::span<const Vec3> directions, int bins);

  size_t size() const { return bins_.size(); }
  const SphereBox& box(size_t bin) const { return bins_[bin].box; }
  /// The directions that lie in the bin.
  std::span<const SpherePoint> points(size_t bin) const { return bins_[bin].points; }
  /// Index of the bin that contains a unit vector.
  size_t find(const Vec3& w) const;

 private:
  struct Bin {
    SphereBox box;
    std::span<const SpherePoint> points;
  };
  struct Node {
    bool by_phi = false;
    double split = 0;
    size_t below = 0, above = 0;  ///< nodes; in a leaf, `below` is the bin
    bool leaf = false;
  };
  size_t build(const SphereBox& box, std::span<SpherePoint> points, int depth);

  size_t largest_count_;
  std::vector<SpherePoint> points_;
  std::vector<Bin> bins_;
  std::vector<Node> nodes_;
  size_t root_;
};

}  // namespace frond
