#pragma once

#include <vector>

#include "core/image.h"

namespace frond {

/// Default viewing condition of FLIP: 0.7 m before a display 0.7 m and 3840 pixels wide.
inline constexpr double kPixelsPerDegree = 67;

/// LDR-FLIP: the perceived difference when flipping between two images of one size, by pixel: 0 (none) to 1. The images
/// are linear red, green and blue with the primaries of sRGB; values outside [0, 1] are clipped, as on a display.
/// P. Andersson, J. Nilsson, T. Akenine-Moller, M. Oskarsson, K. Astrom, M. D. Fairchild, "FLIP: A Difference Evaluator
/// for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020.
std::vector<float> flip_map(const Image& reference, const Image& test, double pixels_per_degree = kPixelsPerDegree);

/// Returns the mean of the map: the paper's single number for two images.
double mean_flip(const Image& reference, const Image& test, double pixels_per_degree = kPixelsPerDegree);

}  // namespace frond
