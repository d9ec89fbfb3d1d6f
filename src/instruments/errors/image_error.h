#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace frond {

inline double square(double x) { return x * x; }

/// Mean over pixels of squared differences, with its standard error. If it is smaller than the noise, the estimate may
/// be negative.
struct MeanSquare {
  double value = 0, standard_error = 0;

  double root() const { return root_of(value); }
  /// Root of the upper end of a confidence interval, `z` standard errors up.
  double root_at(double z) const { return root_of(value + z * standard_error); }

  /// NaN stays NaN, which std::max would take for 0.
  static double root_of(double square) { return square < 0 ? 0 : std::sqrt(square); }
};

/// Number of standard errors of a two-sided 95 % interval of a normal variable.
inline constexpr double kZ95 = 1.96;

/// Difference of one method's image from another's, in one channel. Two renders differ by bias and by noise, which two
/// independent halves of each separate: the mean of (A1 - B1)(A2 - B2) over pixels estimates the squared bias without
/// noise.
struct ImageError {
  double rms = 0;                   ///< of the difference of the full images, (A1 + A2)/2 - (B1 + B2)/2
  double rms_clipped = 0;           ///< the same after clipping both to [0, 1]
  MeanSquare bias_squared;          ///< may be negative if bias is smaller than noise
  double noise = 0;                 ///< root of rms^2 - bias^2
  double noise_a = 0, noise_b = 0;  ///< of each full image, from the difference of its halves
  double mean_difference = 0;       ///< A - B

  double bias() const;
  /// Upper end of the 95 % interval of the bias.
  double bias_upper() const;
};

/// Computes the error of one channel from the four halves, by pixel. `use` (as long, or empty for all pixels) selects
/// pixels by a weight above 0.5. `correlated_pixels`: number of pixels that share the noise of one
/// (Splatting::correlated_pixels); the standard error grows with its root. A value that is not finite makes all numbers
/// NaN.
ImageError image_error(std::span<const float> a1, std::span<const float> a2, std::span<const float> b1,
                       std::span<const float> b2, std::span<const float> use = {}, double correlated_pixels = 1);

}  // namespace frond
