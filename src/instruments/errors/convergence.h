#pragma once

#include <optional>
#include <span>
#include <vector>

#include "instruments/errors/image_error.h"

namespace frond {

/// Noise of a method's render after a number of samples (per pixel) and seconds.
struct ConvergencePoint {
  double samples, seconds;
  MeanSquare noise;
};

/// Samples and seconds that reach an error.
struct Effort {
  double samples, seconds;
  bool measured;  ///< false: extrapolated beyond the last point, with noise as 1 / samples
};

/// Error of a method against work: bias is constant, noise decreases. Between points noise and time are interpolated as
/// power laws.
class Convergence {
 public:
  /// Points in ascending order of samples, at least one.
  Convergence(std::vector<ConvergencePoint> points, MeanSquare bias);

  /// Effort until the noise of one render is at most this mean square; at least the first point's. None if
  /// `mean_square` is not positive.
  std::optional<Effort> until_noise(double mean_square, double z = 0) const;
  /// Effort until bias and noise together are at most `rms`, even if each is `z` standard errors larger than estimated.
  /// None if bias alone is larger.
  std::optional<Effort> until_rms(double rms, double z = 0) const;
  /// Effort until noise is at most bias; further samples have little effect. None if bias is not significant with 97.5
  /// % confidence.
  std::optional<Effort> until_plateau() const;

  /// Mean square of one render's noise after a number of samples; as 1 / samples outside the points.
  double noise_after(double samples) const;

  const MeanSquare& bias() const { return bias_; }
  std::span<const ConvergencePoint> points() const { return points_; }

 private:
  std::vector<ConvergencePoint> points_;
  MeanSquare bias_;
};

/// A point for `pareto_frontier`, in any units.
struct CostAndError {
  double cost, error;
};

/// Returns the indices of the points that no other point beats in both cost and error, by ascending cost.
std::vector<size_t> pareto_frontier(std::span<const CostAndError> points);

}  // namespace frond
