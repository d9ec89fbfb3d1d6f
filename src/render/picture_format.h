#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/wavelengths.h"
#include "render/film.h"

namespace frond {

/// What a film's channels are called and mean in the image that is made of it.
struct PictureFormat {
  std::string space;             ///< linear name of the film's colours; empty: they are bands
  std::vector<Band> bands = {};  ///< of a film of bands
  /// Rows of an affine map from world space to that of positions and normals.
  std::array<std::array<double, 4>, 3> from_world{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  std::map<std::string, std::string> attributes = {};
};

/// Colours, their variances and `leaf`, or those of bands in the layout of image/spectral_layout.h; and the channels
/// that the format asks for.
Image film_image(const Film& film, const PictureFormat& format);

}  // namespace frond
