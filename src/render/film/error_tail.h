#pragma once

#include "render/film/film.h"

namespace frond {

/// How unevenly an image's noise is spread: an image of rare, bright samples has nearly all of its squared error in a
/// few pixels, and more samples may make it worse before they make it better.
struct ErrorTail {
  static constexpr double kWorst = 1e-3;  ///< share of the pixels
  /// Of the sum of all pixels' estimated variances, what the worst kWorst of them hold.
  double share = 0;
  bool is_heavy() const { return share > kHeavy; }

 private:
  static constexpr double kHeavy = 0.5;
};

/// Of a film of colours with 10,000 pixels at least: else too few pixels tell, and the share is 0.
ErrorTail error_tail(const Film& film);

}  // namespace frond
