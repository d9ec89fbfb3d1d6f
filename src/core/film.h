#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/plugin.h"

namespace frond {

/// A rectangle of pixels.
struct Crop {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< pixels; the end is not in it
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  friend bool operator==(const Crop&, const Crop&) = default;
};

/// What the scene says of the image. A crop holds one pixel at least, and lies on the film.
struct FilmSettings {
  int width = 0, height = 0;  ///< full resolution, pixels
  Crop crop = {};
  std::string filename = "frond.exr";
  bool half = false;    ///< EXR with 16-bit floats
  double exposure = 1;  ///< factor from radiance to film
  /// Of a sample's response, which is scaled down to it; infinity: not at all.
  double max_component = std::numeric_limits<double>::infinity();

  std::vector<std::string> channels = {};  ///< beside colour: names of render/film/channels.h
  bool features_in_camera_space = false;   ///< normals and positions; else in world space

  /// That a channel of an EXR can have.
  double largest_value() const { return half ? 65504 : double(std::numeric_limits<float>::max()); }
};

/// A film is its settings: accumulators and files are the renderer's own (render/film/).
struct FilmInfo : PluginInfo {
  FilmSettings (*make)(const Params&);
};

}  // namespace frond
