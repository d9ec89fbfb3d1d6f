#pragma once

#include <array>
#include <map>
#include <stop_token>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/wavelengths.h"
#include "render/film/film.h"

namespace frond {

/// What a film's channels are called and mean in the image that is made of it.
struct ImageFormat {
  std::string space;             ///< linear name of the film's colours; empty: they are bands
  std::vector<Band> bands = {};  ///< of a film of bands
  /// Rows of an affine map from world space to that of positions and normals.
  std::array<std::array<double, 4>, 3> from_world{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  std::map<std::string, std::string> attributes = {};
};

/// Colours, their variances and `leaf`, or those of bands in the layout of image/spectral_layout.h; and the channels
/// that the format asks for.
Image film_image(const Film& film, const ImageFormat& format);

/// What film_image has of what is seen: colours, or bands and the colours that stand for them; no variances, no further
/// channels. Black.
Image empty_image(const Film& film, const ImageFormat& format);
/// Fills it with what the film holds by now. Others may render meanwhile: each tile is that of whole items. False where
/// `stop` was asked for first.
bool renew_image(const Film& film, const ImageFormat& format, const std::stop_token& stop, Image& image);

}  // namespace frond
