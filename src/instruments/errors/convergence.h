#pragma once

#include <optional>
#include <span>
#include <vector>

#include "instruments/errors/image_error.h"

namespace frond {

/// What one method has reached after so much work.
struct ConvergencePoint {
  double samples, seconds;
  MeanSquare noise;
};

/// Work that is needed for something.
struct Effort {
  double samples, seconds;
  bool measured;  ///< false: beyond the last point, where noise is taken to go on as 1 / samples
};

/// How a method's error falls with work: bias stays, noise goes. Between points noise and time follow power laws.
class Convergence {
 public:
  /// Points in the order of their samples, one at least.
  Convergence(std::vector<ConvergencePoint> points, MeanSquare bias);

  /// Until the noise of one render is down to this mean square; of no work less than the first point's. Nothing where
  /// `mean_square` is not positive.
  std::optional<Effort> until_noise(double mean_square, double z = 0) const;
  /// Until bias and noise together are down to `rms`, even if each is `z` standard errors larger than it seems. Nothing
  /// where bias alone is too large.
  std::optional<Effort> until_rms(double rms, double z = 0) const;
  /// Until noise is no more than bias: from there on more samples help little. Nothing where no bias can be told from
  /// none with 97.5 % confidence.
  std::optional<Effort> until_plateau() const;

  /// Mean square of one render's noise after so many samples; before the first point and after the last as 1 / samples.
  double noise_after(double samples) const;

  const MeanSquare& bias() const { return bias_; }
  std::span<const ConvergencePoint> points() const { return points_; }

 private:
  std::vector<ConvergencePoint> points_;
  MeanSquare bias_;
};

struct CostAndError {
  double cost, error;
};

/// Those that no other beats in cost and error at once, by rising cost: their places in the list.
std::vector<size_t> pareto_frontier(std::span<const CostAndError> points);

}  // namespace frond
