#pragma once

#include <string>

#include "core/image.h"

namespace frond {

/// Returns the image reduced to at most `columns` x 2 `rows` pixels by averaging (box filter), so that its
/// terminal_text fits into that many columns and rows. The aspect ratio is kept; an image is never enlarged.
Image fitted_image(const Image& image, int columns, int rows);

/// Returns text that displays an image on a terminal: each character is an upper half block in 24-bit colours (ANSI
/// escape codes) and shows two pixels, one above the other. `shown` has the channels R, G, B, encoded for a display, in
/// [0, 1]. Every line ends with a reset of the colours and a newline.
std::string terminal_text(const Image& shown);

}  // namespace frond
