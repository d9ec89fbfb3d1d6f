#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "scene/geometry/density_table.h"

namespace frond {

/// Leaf angle distribution: share of the leaf area by the angle between a leaf's normal and the vertical, the
/// inclination of the leaf. Azimuths are uniform.
struct LeafAngles {
  std::string name;
  /// Density over the angle (radians, 0 to pi/2), not normalized; empty for horizontal leaves.
  std::function<double(double theta)> density;
  /// Integral of the density between two angles, where its value between them does not give it; else empty.
  std::function<double(double from, double to)> integral = {};
  std::optional<double> chi = {};  ///< of an ellipsoidal distribution

  /// Number of the equal intervals of the angle in which distributions are integrated.
  static constexpr int kSteps = 1 << 14;
  /// Returns the share of the i-th interval, not normalized.
  double share(int i) const;
  /// Returns the mean inclination in radians.
  double mean() const;
};

/// Returns de Wit's distributions (1965), as written by Goel and Strebel 1984 (Agronomy Journal 76:800-802), the
/// spherical one and the horizontal one.
std::span<const LeafAngles> leaf_angle_distributions();

/// Limits of the parameter chi: beyond them leaves are vertical or horizontal within a degree on average.
inline constexpr double kLeastChi = 0.01, kMostChi = 100;
/// Returns the ellipsoidal distribution (Campbell 1990, Agricultural and Forest Meteorology 49:173-176): normals as
/// those of an ellipsoid's surface, whose horizontal half axis is `chi` times the vertical one. 1: spherical.
LeafAngles ellipsoidal_angles(double chi);
/// Returns the chi of the ellipsoidal distribution with a mean inclination (radians); it is solved for, not
/// approximated. Throws InputError if it is beyond the limits.
double chi_of_mean(double mean);

/// Returns the beta distribution of 2 theta / pi (Goel and Strebel 1984), both parameters above 0; the mean
/// inclination is 90 degrees * nu / (mu + nu).
LeafAngles beta_angles(double mu, double nu);

/// Returns the distribution of a table over the angle in radians.
LeafAngles tabulated_angles(std::string name, const DensityTable& table);

}  // namespace frond
