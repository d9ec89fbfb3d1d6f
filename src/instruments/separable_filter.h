#pragma once

#include <span>
#include <vector>

namespace frond {

/// One channel of an image, rows from the top.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> v;
};

/// Correlates with `along_x` in every row, then with `along_y` in every column. Both have an odd length and their
/// centre in the middle; beyond the edges the image goes on with its outermost pixels.
Plane separable_filter(const Plane& image, std::span<const double> along_x, std::span<const double> along_y);

}  // namespace frond
