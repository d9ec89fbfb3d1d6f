#pragma once

#include <array>
#include <span>

namespace frond {

/// An estimate with the half width of its 95 % confidence interval.
struct Estimate {
  double value = 0, half_width = 0;
};

/// How one method's image differs from another's, in one channel. Two renders differ by bias and by noise; two
/// independent halves of each tell them apart, since the mean of (A1 - B1)(A2 - B2) over pixels estimates bias squared
/// without any noise in it.
struct ImageError {
  double rms = 0;                   ///< of the difference of the full images, (A1 + A2)/2 - (B1 + B2)/2
  double rms_clipped = 0;           ///< the same after clipping both to [0, 1]
  Estimate bias_squared;            ///< may come out negative where there is less bias than noise
  double noise = 0;                 ///< root of what bias leaves of rms squared
  double noise_a = 0, noise_b = 0;  ///< of each full image alone, from how its halves differ
  double mean_difference = 0;       ///< A - B

  double bias() const;
  /// Upper end of the 95 % interval of the bias.
  double bias_upper() const;
};

/// The four halves, pixel by pixel, of one channel. `use` (as long, or empty for all pixels) picks pixels by a weight
/// above 0.5.
ImageError image_error(std::span<const float> a1, std::span<const float> a2, std::span<const float> b1,
                       std::span<const float> b2, std::span<const float> use = {});

}  // namespace frond
