#pragma once

#include <string>

#include "core/image.h"

namespace frond {

/// The image in `columns` x 2 `rows` pixels at most, each the mean of those that it stands for: what terminal_text
/// makes of it then fits into so many columns and rows. Its sides keep their ratio; it is never enlarged.
Image fitted_image(const Image& image, int columns, int rows);

/// Text that shows an image on a terminal: a character for two pixels, one above the other, as upper half blocks in
/// colours of 24 bits (ANSI escape codes). `shown`: R, G, B from 0 to 1, encoded for a display. Every line ends with
/// the terminal's own colours and a newline.
std::string terminal_text(const Image& shown);

}  // namespace frond
