#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/plugin.h"

namespace frond {

struct Crop {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< pixels; the end is not in it
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  friend bool operator==(const Crop&, const Crop&) = default;
};

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

/// What the scene says of the image.
struct FilmSettings {
  int width = 0, height = 0;  ///< full resolution, pixels
  Crop crop = {};
  std::string filename;
  bool half = false;         ///< EXR with 16-bit floats
  double exposure = 1;       ///< factor from radiance to film
  double max_component = 0;  ///< of a sample's response, which is scaled down to it; infinity: not at all

  std::vector<std::string> channels = {};  ///< beside colour: names of render/film/channels.h
  bool features_in_camera_space = false;   ///< normals and positions; else in world space

  /// That a channel of an EXR can have.
  double largest_value() const { return half ? 65504 : double(std::numeric_limits<float>::max()); }
};

/// The same picture at half the resolution; the crop keeps a pixel at least.
FilmSettings halved(FilmSettings settings);

struct FilmInfo : PluginInfo {
  FilmSettings (*make)(const Params&);
};

}  // namespace frond
