#pragma once

#include <vector>

#include "render/render_loop.h"

namespace frond::choose {

/// Returns about `count` pixels of the crop: one at random from each cell of a grid, each pixel with the same
/// probability, so that their mean is an unbiased estimate of the image's mean. Returns all pixels if there are not
/// more.
std::vector<PixelPosition> pilot_pixels(const Crop& crop, size_t count, uint64_t seed);

}  // namespace frond::choose
