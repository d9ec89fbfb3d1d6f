#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "leaf/tissue/tissue.h"

namespace frond::leaf {

/// Version of the solution. Increase with any change that may change results: tables on disk are stored under it.
inline constexpr int kModesVersion = 3;

/// BSDF of the light that has been inside a leaf, at one wavelength and without noise, as a Fourier series over
/// azimuth:
///   f = (1 - F_i) (1 - F_o) / mu_o' * sum over m of h_m(sin theta_i, sin theta_o) cos(m phi)   [1/sr],
/// where F_i and F_o are the Fresnel reflectances of the outer surface for the two directions outside; mu_o' = sqrt(1 -
/// (sin theta_o / n)^2) is the cosine inside; phi = 0 is straight ahead, phi = pi back. The factors before the sum hold
/// everything that is steep at grazing; h_m is smooth in both sines, even in each for even m and odd for odd m.
class LeafModes {
 public:
  /// Values of one mode: [index of the incident sine][index of the leaving sine].
  using Grid = std::vector<double>;

  LeafModes() = default;
  /// `sines`: ascending grid of sin theta for both directions.
  explicit LeafModes(std::vector<double> sines) : sines_(std::move(sines)) {}

  const std::vector<double>& sines() const { return sines_; }
  /// Modes, in order, for light that meets the leaf from below or from above and leaves it on the other side
  /// (`crosses`) or on the same side.
  std::vector<Grid>& series(bool from_below, bool crosses) { return series_[from_below][crosses]; }
  const std::vector<Grid>& series(bool from_below, bool crosses) const { return series_[from_below][crosses]; }

 private:
  std::vector<double> sines_;
  std::array<std::array<std::vector<Grid>, 2>, 2> series_;
};

/// Solves the modes by the chain of leaf/solve/solver.h; truncates the series where the remaining modes sum to less
/// than `tolerance` of pi f (1 for a white Lambertian surface). `sines`: of angles outside, for both directions,
/// between -n and n, the cuticle's index. `nodes` per segment.
LeafModes solve_modes(const Tissue& tissue, std::span<const double> sines, double tolerance, int nodes);

/// Returns the number of nodes per segment for errors of pi f below 3e-5 if all lobes inside the leaf have exponents
/// from 1 to 20 (the specimens' have 1 and 5), and below 1e-4 of its largest value up to 100; 1e-3 at 0.5; 3e-3 at 0,
/// where the cut of the lobe leaves an edge. Found by comparison with twice as many nodes.
int mode_nodes(const Tissue& tissue);

/// Returns (1 - F_i) (1 - F_o) / mu_o' for directions outside with these cosines to the normal.
double interface_transmittance(const Tissue& tissue, double cos_i, double cos_o);

}  // namespace frond::leaf
