#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "leaf/tissue/tissue.h"

namespace frond::leaf {

/// Increase with any change that may change results: tables on disk are kept by it.
inline constexpr int kModesVersion = 3;

/// f of light that has been inside a leaf, at one wavelength and without noise, as a Fourier series over azimuth:
///   f = (1 - F_i) (1 - F_o) / mu_o' * sum over m of h_m(sin theta_i, sin theta_o) cos(m phi)   [1/sr],
/// F_i, F_o: Fresnel's reflectances of the outer surface for the two directions outside; mu_o' = sqrt(1 - (sin theta_o
/// / n)^2), the cosine inside; phi = 0: on straight ahead, pi: back. What is outside the sum holds all that is steep at
/// grazing; h_m is smooth in both sines, even in each for even m and odd for odd m.
class LeafModes {
 public:
  /// Values of one mode: [index of the incident sine][index of the leaving sine].
  using Grid = std::vector<double>;

  LeafModes() = default;
  explicit LeafModes(std::vector<double> sines) : sines_(std::move(sines)) {}

  const std::vector<double>& sines() const { return sines_; }
  /// Series for light that meets the leaf from below or above and leaves it on the same side or on the other.
  std::vector<Grid>& series(bool from_below, bool crosses) { return series_[from_below][crosses]; }
  const std::vector<Grid>& series(bool from_below, bool crosses) const { return series_[from_below][crosses]; }

 private:
  std::vector<double> sines_;
  std::array<std::array<std::vector<Grid>, 2>, 2> series_;
};

/// The walk's modes, by the chain of `solve` (leaf/solve/solver.h), as many as it takes to leave out less than
/// `tolerance` of pi f, which is 1 for white paper. `sines` of angles outside, for both directions: between -n and n, n
/// the cuticle's index. `nodes` per segment.
LeafModes solve_modes(const Tissue& tissue, std::span<const double> sines, double tolerance, int nodes);

/// Enough nodes for errors of pi f below 3e-5 where all lobes inside the leaf have exponents from 1 to 20 (the
/// specimens' have 1 and 5), and below 1e-4 of its largest value up to 100; 1e-3 at 0.5; 3e-3 at 0, where the cut
/// leaves an edge. Found by comparing with twice as many.
int mode_nodes(const Tissue& tissue);

/// Of directions outside with these cosines to the normal, (1 - F_i) (1 - F_o) / mu_o'.
double passage(const Tissue& tissue, double cos_i, double cos_o);

}  // namespace frond::leaf
