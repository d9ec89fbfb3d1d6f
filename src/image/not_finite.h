#pragma once

#include <string>

#include "core/image.h"

namespace frond {

/// Returns how many values of an image are not finite, as in "12 NaN and 3 infinite values in 5 of 256 pixels"; an
/// empty text if all are.
std::string not_finite_text(const Image& image);

}  // namespace frond
