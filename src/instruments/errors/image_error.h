#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace frond {

/// A mean over pixels of squared differences, with its standard error. Where there is less of it than noise, the
/// estimate may come out negative.
struct MeanSquare {
  double value = 0, standard_error = 0;

  double root() const { return std::sqrt(std::max(0.0, value)); }
  /// Root of the end of a confidence interval that lies `z` standard errors up.
  double root_at(double z) const { return std::sqrt(std::max(0.0, value + z * standard_error)); }
};

/// Two-sided 95 % of a normal variable, in standard errors.
inline constexpr double kZ95 = 1.96;

/// How one method's image differs from another's, in one channel. Two renders differ by bias and by noise; two
/// independent halves of each tell them apart, since the mean of (A1 - B1)(A2 - B2) over pixels estimates bias squared
/// without any noise in it.
struct ImageError {
  double rms = 0;                   ///< of the difference of the full images, (A1 + A2)/2 - (B1 + B2)/2
  double rms_clipped = 0;           ///< the same after clipping both to [0, 1]
  MeanSquare bias_squared;          ///< may come out negative where there is less bias than noise
  double noise = 0;                 ///< root of what bias leaves of rms squared
  double noise_a = 0, noise_b = 0;  ///< of each full image alone, from how its halves differ
  double mean_difference = 0;       ///< A - B

  double bias() const;
  /// Upper end of the 95 % interval of the bias.
  double bias_upper() const;
};

/// The four halves, pixel by pixel, of one channel. `use` (as long, or empty for all pixels) picks pixels by a weight
/// above 0.5. `correlated_pixels`: how many share the noise of one (Splatting::correlated_pixels); the standard error
/// grows by its root.
ImageError image_error(std::span<const float> a1, std::span<const float> a2, std::span<const float> b1,
                       std::span<const float> b2, std::span<const float> use = {}, double correlated_pixels = 1);

}  // namespace frond
