#pragma once

#include <span>

#include "core/image.h"

namespace frond {

/// Correlates an image of one channel with `along_x` in every row, then with `along_y` in every column. Both have an
/// odd length, with the centre in the middle; beyond the edges the outermost pixels are repeated.
Image separable_filter(const Image& image, std::span<const double> along_x, std::span<const double> along_y);

}  // namespace frond
