#pragma once

#include "render/film/film.h"

namespace frond {

/// Concentration of an image's noise in a few pixels. If rare, bright samples dominate, nearly all of the squared error
/// is in a few pixels, and more samples can increase it before they reduce it.
struct ErrorTail {
  static constexpr double kWorst = 1e-3;  ///< share of the pixels that count as the worst
  /// Share of the worst pixels in the sum of the estimated variances of all pixels.
  double share = 0;
  /// True if the worst pixels hold more than half of the variance.
  bool is_heavy() const { return share > kHeavy; }

 private:
  static constexpr double kHeavy = 0.5;
};

/// Error tail of a film. The share is 0 for fewer than 10,000 pixels, which are too few to estimate it, and for bands.
ErrorTail error_tail(const Film& film);

}  // namespace frond
