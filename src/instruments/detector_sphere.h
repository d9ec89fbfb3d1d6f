#pragma once

#include "core/math/vec.h"
#include "instruments/guided_edges.h"

namespace frond {

/// One detector of a goniophotometer. Angles in degrees: theta from +z, phi about it from the light's azimuth.
struct Patch {
  double theta_min_deg, theta_max_deg;
  double phi_min_deg, phi_max_deg;  ///< phi_min may be negative: the first patch lies on both sides of phi = 0
  double solid_angle;               ///< sr
  double projected_solid_angle;     ///< integral of |cos theta| over the patch, sr

  double theta_deg() const { return (theta_min_deg + theta_max_deg) / 2; }
  double phi_deg() const { return (phi_min_deg + phi_max_deg) / 2; }
};

/// A collector sphere around a specimen, divided evenly in theta ("along its latitude") and in phi ("along its
/// longitude"), as in Baranoski and Rokne, section 4: 20 x 40 patches are 9 degrees wide each way, ten rows of them
/// above the specimen and ten below. Patches are centred on phi = 0, 360 / phis, ..., so that the plane of incidence
/// passes through the middle of the first patch and, if `phis` is even, of the opposite one.
class DetectorSphere {
 public:
  static constexpr int kMostPatches = 16'000'000;

  /// Throws InputError unless thetas >= 2 and even (no patch may cross the horizon), phis >= 1, and there are at most
  /// kMostPatches.
  DetectorSphere(int thetas, int phis);

  int thetas() const { return thetas_; }
  int phis() const { return phis_; }
  size_t size() const { return static_cast<size_t>(thetas_) * static_cast<size_t>(phis_); }
  /// Index of a patch: rows from the +z pole, columns by azimuth.
  size_t index(int theta, int phi) const {
    return static_cast<size_t>(theta) * static_cast<size_t>(phis_) + static_cast<size_t>(phi);
  }

  Patch patch(int theta, int phi) const;
  Patch patch(size_t i) const;
  /// Returns the index of the patch that contains a unit vector.
  size_t find(const Vec3& w) const {
    const size_t row = static_cast<size_t>(thetas_) - 1 - z_.find(double(w.z));
    const size_t column = diamond_.find(diamond_angle(double(w.x), double(w.y)));
    return row * static_cast<size_t>(phis_) + (column == static_cast<size_t>(phis_) ? 0 : column);
  }

 private:
  /// Increases with the azimuth from 0 to 4 like that of a point on the square |x| + |y| = 1; costs one division
  /// instead of an arc tangent.
  static double diamond_angle(double x, double y) {
    const double sum = (x < 0 ? -x : x) + (y < 0 ? -y : y);
    if (sum == 0) return 0;
    const double r = y / sum;
    return x < 0 ? 2 - r : (y < 0 ? 4 + r : r);
  }
  static std::vector<double> z_edges(int thetas);
  static std::vector<double> diamond_edges(int phis);

  int thetas_, phis_;
  GuidedEdges z_;        ///< cos theta, from -1 to 1
  GuidedEdges diamond_;  ///< phi; the first interval and the last are halves of the first patch
};

}  // namespace frond
