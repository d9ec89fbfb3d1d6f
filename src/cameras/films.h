#pragma once

#include <span>

#include "core/film.h"

namespace frond {

/// Sorts each pair of bounds x0, x1, y0, y1, because some exporters write them in the wrong order. Returns whether any
/// pair was exchanged.
template <class Bounds>
bool put_in_order(Bounds& bounds) {
  bool is_changed = false;
  for (size_t i = 0; i + 1 < bounds.size(); i += 2)
    if (bounds[i + 1] < bounds[i]) std::swap(bounds[i], bounds[i + 1]), is_changed = true;
  return is_changed;
}

/// Returns the pixels of a window x0 x1 y0 y1 given as fractions of the film; ends are rounded up as in pbrt.
Crop crop_of_fractions(std::span<const double> window, int width, int height);
/// Returns the part of the bounds (pixels) that lies on the film.
Crop crop_of_pixels(std::span<const int> bounds, int width, int height);

/// Returns the settings at half the resolution; the crop keeps at least one pixel.
FilmSettings halved(FilmSettings settings);

}  // namespace frond
