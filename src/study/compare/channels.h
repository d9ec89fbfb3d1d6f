#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "spectra/matrix3.h"

namespace frond::compare {

/// The space in which errors of colours are measured.
inline constexpr std::string_view kErrorSpace = "linear SMPTE-C";

/// The place, in a list of channels, of all those of the film together: their mean square.
inline constexpr size_t kTogether = 0;
/// That of the film's first channel; the others follow.
inline constexpr size_t kFirst = 1;

/// What errors are reported of: all channels of the film together, each by itself, and luminance where they are
/// colours.
struct ChannelList {
  std::vector<std::string> names = {};
  std::vector<Triple> shown = {};  ///< of each channel of the film: what it adds to an image's linear SMPTE-C
  std::vector<Band> bands = {};    ///< empty: red, green and blue
  std::vector<double> white = {};  ///< of each band: what the film holds where errors count 1
  std::string unit = {};           ///< of errors
  std::string how_shown = {};      ///< of bands: how an image is made of them

  size_t film_channels() const { return shown.size(); }
  bool are_bands() const { return !bands.empty(); }
  /// The place of luminance, of colours.
  size_t luminance() const { return kFirst + film_channels(); }
};

/// Of a film of this scene. Colours: red, green, blue and luminance of linear SMPTE-C. Bands: radiance over that of a
/// white diffuse surface of luminance 1 in the light of the scene's lights together. Throws InputError for a band in
/// which they give no light.
ChannelList channels_of(const Scene& scene);

/// Samples of a pixel after which each channel of its film has been seen.
uint64_t samples_for_all_channels(const Scene& scene);

/// Whether two films hold the same.
bool same_channels(const ChannelList& a, const ChannelList& b);

}  // namespace frond::compare
