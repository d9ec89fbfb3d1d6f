#pragma once

#include <vector>

#include "render/render_loop.h"

namespace frond::choose {

/// About `count` pixels of an image, one drawn from each cell of a grid, every pixel with the same probability: their
/// mean is that of the image at its full resolution, details and all. All pixels where there are no more.
std::vector<PixelPosition> pilot_pixels(const Crop& crop, size_t count, uint64_t seed);

}  // namespace frond::choose
