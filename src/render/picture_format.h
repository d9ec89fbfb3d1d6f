#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/wavelengths.h"
#include "image/image.h"
#include "render/film.h"

namespace frond {

/// What a film's channels are called and mean in the image that is made of it.
struct PictureFormat {
  std::string space;                       ///< linear name of the film's colours; empty: they are bands
  std::vector<Band> bands = {};            ///< of a film of bands
  std::vector<std::string> channels = {};  ///< beside colours or bands, their variances and `leaf`: of kChannels
  /// Rows of an affine map from world space to that of positions and normals.
  std::array<std::array<double, 4>, 3> from_world{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  std::map<std::string, std::string> attributes = {};
};

/// A channel, or three, that an image may have beside its colours.
struct ChannelInfo {
  std::string_view name;                ///< as --channels takes it
  std::array<std::string_view, 3> exr;  ///< as the file calls them; empty: there are no more
  bool is_feature;                      ///< of what camera rays met first
  std::string_view doc;
};

/// Names as Blender, Nuke and Open Image Denoise know them.
inline constexpr ChannelInfo kChannels[] = {
    {"albedo", {"albedo.R", "albedo.G", "albedo.B"}, true, "share of light that the surface gives back, on both sides"},
    {"normal", {"normal.X", "normal.Y", "normal.Z"}, true, "shading normal, on the surface's front"},
    {"depth", {"Z", "", ""}, true, "distance from the camera along its axis"},
    {"position", {"P.X", "P.Y", "P.Z"}, true, "place of the surface"},
    {"material",
     {"materialId", "", ""},
     true,
     "place of the material in the scene file, from 1; names are in the header"},
    {"instance", {"instanceId", "", ""}, true, "place of the ObjectInstance in the scene file, from 1"},
    {"samples", {"samples", "", ""}, false, "samples of the pixel"},
};

/// By names; throws InputError that lists them. Each once, in the order of kChannels.
std::vector<std::string> checked_channels(const std::vector<std::string>& names, const Location& where);
/// Whether a film has to have features for them.
bool have_features(const std::vector<std::string>& channels);

/// Colours, their variances and `leaf`, or those of bands in the layout of image/spectral_layout.h; and the channels
/// that the format asks for.
Image film_image(const Film& film, const PictureFormat& format);

}  // namespace frond
