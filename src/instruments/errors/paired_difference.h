#pragma once

#include <array>
#include <span>
#include <vector>

#include "instruments/errors/statistics.h"

namespace frond {

/// How one method's image differs from another's, pixel by pixel, in two independent pairs of renders: noise of the
/// first says nothing of the second's. Within a pair the two renders may share their random numbers, which makes the
/// difference less noisy where their paths are alike.
struct PairedDifference {
  std::array<std::vector<float>, 2> half;  ///< the channels of a pixel next to each other
  size_t channels = 0;

  size_t pixels() const { return channels > 0 ? half[0].size() / channels : 0; }
};

/// Mean square over pixels and channels of the difference that stays however many samples are taken. The pixels are
/// taken to be drawn at random from the image, so that the spread among them is uncertainty too.
Estimate mean_square(const PairedDifference& difference);

/// Where such a mean square lies, at `z` as in `confidence_interval`. It is none below 0: what noise makes of it there
/// takes nothing off the upper end, and no skewness below 0 does.
ConfidenceInterval mean_square_interval(const Estimate& mean_square, double z);

/// Mean product of two differences, without their noise.
double mean_product(const PairedDifference& a, const PairedDifference& b);

}  // namespace frond
