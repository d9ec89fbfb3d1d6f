#include "instruments/errors/image_error.h"

#include <algorithm>
#include <cmath>

namespace frond {

double ImageError::bias() const { return bias_squared.root(); }

double ImageError::bias_upper() const { return bias_squared.root_at(kZ95); }

ImageError image_error(std::span<const float> a1, std::span<const float> a2, std::span<const float> b1,
                       std::span<const float> b2, std::span<const float> use, double correlated_pixels) {
  bool is_finite = true;
  double n = 0, total = 0, clipped = 0, product = 0, product_variance = 0, difference = 0, gap_a = 0, gap_b = 0;
  for (size_t i = 0; i < a1.size(); ++i) {
    if (!use.empty() && !(use[i] > 0.5f)) continue;
    const double a = (double(a1[i]) + double(a2[i])) / 2, b = (double(b1[i]) + double(b2[i])) / 2;
    const double d1 = double(a1[i]) - double(b1[i]), d2 = double(a2[i]) - double(b2[i]), gap2 = square(d1 - d2);
    n += 1;
    is_finite = is_finite && std::isfinite(d1) && std::isfinite(d2);
    difference += a - b;
    gap_a += square(double(a1[i]) - double(a2[i]));
    gap_b += square(double(b1[i]) - double(b2[i]));
    total += square(a - b);
    clipped += square(std::clamp(a, 0.0, 1.0) - std::clamp(b, 0.0, 1.0));
    product += d1 * d2;
    // With d = delta + e, e normal of variance s^2: Var(d1 d2) = 2 delta^2 s^2 + s^4, of which this is an unbiased
    // estimate.
    product_variance += d1 * d2 * gap2 + square(gap2) / 4;
  }
  ImageError e;
  if (n == 0) return e;
  if (!is_finite) {
    constexpr double kNone = NAN;
    return {kNone, kNone, {kNone, kNone}, kNone, kNone, kNone, kNone};
  }
  e.rms = std::sqrt(total / n);
  e.rms_clipped = std::sqrt(clipped / n);
  // Variances of pixels add as if independent; covariances increase the sum by at most this factor.
  e.bias_squared = {product / n, std::sqrt(std::max(0.0, product_variance) * correlated_pixels) / n};
  e.noise = std::sqrt(std::max(0.0, total / n - std::max(0.0, e.bias_squared.value)));
  e.noise_a = std::sqrt(gap_a / n) / 2;
  e.noise_b = std::sqrt(gap_b / n) / 2;
  e.mean_difference = difference / n;
  return e;
}

}  // namespace frond
