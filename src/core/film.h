#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/plugin.h"

namespace frond {

/// Rectangle of pixels: x0 <= x < x1, y0 <= y < y1.
struct Crop {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  friend bool operator==(const Crop&, const Crop&) = default;
};

/// Settings of the film. The crop contains at least one pixel and lies inside the film.
struct FilmSettings {
  int width = 0, height = 0;  ///< full resolution, pixels
  Crop crop = {};
  std::string filename = "frond.exr";
  bool half = false;    ///< EXR with 16-bit floats
  double exposure = 1;  ///< factor from radiance to film values
  /// Largest component of a sample's response; a larger response is scaled down to it (pbrt's maxcomponentvalue).
  double max_component = std::numeric_limits<double>::infinity();

  std::vector<std::string> channels = {};  ///< additional channels: names of render/film/channels.h
  int buckets = 0;               ///< number of spectral channels beside the colours: mean radiance in intervals
  Interval buckets_nm = {0, 0};  ///< the wavelengths that the buckets divide into equal intervals
  bool features_in_camera_space = false;  ///< space of normals and positions: camera space, else world space

  /// Largest finite value of a channel of the EXR file.
  double largest_value() const { return half ? 65504 : double(std::numeric_limits<float>::max()); }
};

/// Plug-in record of a film. `make` returns settings only, and throws InputError; the renderer accumulates samples and
/// writes files (render/film/).
struct FilmInfo : PluginInfo {
  FilmSettings (*make)(const Params&);
};

}  // namespace frond
