#include "instruments/errors/paired_difference.h"

#include <algorithm>

namespace frond {
namespace {

/// Product of the two halves' differences of one pixel, mean over its channels.
double product(const PairedDifference& a, size_t a_half, const PairedDifference& b, size_t b_half, size_t pixel) {
  double sum = 0;
  for (size_t c = 0; c < a.channels; ++c) {
    const size_t i = pixel * a.channels + c;
    sum += static_cast<double>(a.half[a_half][i]) * static_cast<double>(b.half[b_half][i]);
  }
  return sum / static_cast<double>(a.channels);
}

}  // namespace

Estimate mean_square(const PairedDifference& difference) {
  Moments moments;
  for (size_t i = 0; i < difference.pixels(); ++i) moments.add(product(difference, 0, difference, 1, i));
  return moments.estimate();
}

ConfidenceInterval mean_square_interval(const Estimate& mean_square, double z) {
  const ConfidenceInterval skewed = confidence_interval(mean_square, z);
  const double even = std::max(0.0, mean_square.mean) + z * mean_square.standard_error();
  return {std::max(0.0, skewed.low), std::max(skewed.high, even)};
}

double mean_product(const PairedDifference& a, const PairedDifference& b) {
  Moments moments;
  for (size_t i = 0; i < a.pixels(); ++i) moments.add((product(a, 0, b, 1, i) + product(a, 1, b, 0, i)) / 2);
  return moments.mean();
}

}  // namespace frond
