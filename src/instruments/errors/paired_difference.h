#pragma once

#include <array>
#include <span>
#include <vector>

#include "instruments/errors/statistics.h"

namespace frond {

/// Difference of one method's image from another's, by pixel, in two pairs of renders whose noise is independent.
/// Within a pair the two renders may share random numbers, which reduces the noise of the difference where their paths
/// are similar.
struct PairedDifference {
  std::array<std::vector<float>, 2> half;  ///< the channels of a pixel are adjacent
  size_t channels = 0;

  size_t pixels() const { return channels > 0 ? half[0].size() / channels : 0; }
};

/// Mean square, over pixels and channels, of the difference without noise. The pixels are treated as a random sample of
/// the image, so their spread is part of the uncertainty.
Estimate mean_square(const PairedDifference& difference);

/// Confidence interval of such a mean square, with `z` as in `confidence_interval`. Clamped to values of at least 0:
/// noise that makes the estimate negative does not lower the upper end, nor does negative skewness.
ConfidenceInterval mean_square_interval(const Estimate& mean_square, double z);

/// Mean product of two differences, unbiased by their noise.
double mean_product(const PairedDifference& a, const PairedDifference& b);

}  // namespace frond
