#pragma once

#include <array>
#include <map>
#include <stop_token>
#include <string>
#include <vector>

#include "core/wavelengths.h"
#include "image/image_file.h"
#include "render/film/cryptomatte.h"
#include "render/film/film.h"

namespace frond {

/// Names and meanings of the channels of an image made from a film.
struct ImageFormat {
  std::string space;             ///< linear name of the colour space; empty if the channels are bands
  std::vector<Band> bands = {};  ///< the bands or buckets, if the film has any
  /// First three rows of the matrix from world space to the space of positions and normals.
  std::array<std::array<double, 4>, 3> from_world{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  std::map<std::string, std::string> attributes = {};  ///< for the header of the image file
  std::map<std::string, HeaderMatrix> matrices = {};   ///< the same
  MatteNames names = {};                               ///< for channels of Cryptomatte
  int samples = 0;  ///< samples per pixel, for the header; 0: unknown, or not the same in all pixels
};

/// Image of a film: colours, or bands in the layout of image/spectral_layout.h, their variances, `leaf`, and the film's
/// additional channels.
Image film_image(const Film& film, const ImageFormat& format);

/// Black image for a viewer. Its channels are the colours, or the bands and their preview colours, of film_image,
/// without variances and additional channels.
Image empty_image(const Film& film, const ImageFormat& format);
/// Updates such an image from a film that other threads may be adding to; each tile contains complete work items only.
/// Returns false if `stop` was requested before the end.
bool update_image(const Film& film, const ImageFormat& format, const std::stop_token& stop, Image& image);

}  // namespace frond
