#pragma once

#include <span>

#include "core/film.h"

namespace frond {

/// Ends the wrong way round, as some exporters write them, are exchanged: x0, x1, y0, y1. Says whether any were.
template <class Bounds>
bool put_in_order(Bounds& bounds) {
  bool is_changed = false;
  for (size_t i = 0; i + 1 < bounds.size(); i += 2)
    if (bounds[i + 1] < bounds[i]) std::swap(bounds[i], bounds[i + 1]), is_changed = true;
  return is_changed;
}

/// Pixels of a window x0 x1 y0 y1 that is given as fractions of a film, ends rounded up as in pbrt.
Crop crop_of_fractions(std::span<const double> window, int width, int height);
/// As far as it lies on the film.
Crop crop_of_pixels(std::span<const int> bounds, int width, int height);

/// The same image at half the resolution; the crop keeps a pixel at least.
FilmSettings halved(FilmSettings settings);

}  // namespace frond
