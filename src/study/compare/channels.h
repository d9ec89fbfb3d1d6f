#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "spectra/matrix3.h"

namespace frond::compare {

/// Colour space in which errors of colours are measured.
inline constexpr std::string_view kErrorSpace = "linear SMPTE-C";

/// Index of the entry for all channels of the film together: their mean square.
inline constexpr size_t kTogether = 0;
/// Index of the film's first channel; the others follow.
inline constexpr size_t kFirst = 1;

/// Channels for which errors are reported: all channels of the film together, each channel, and luminance if they are
/// colours.
struct ChannelList {
  std::vector<std::string> names = {};
  std::vector<Triple> shown = {};  ///< contribution of each channel of the film to an image in linear SMPTE-C
  std::vector<Band> bands = {};    ///< empty: red, green and blue
  std::vector<double> white = {};  ///< value of each band that errors are relative to (1 if they are colours)
  std::string unit = {};           ///< of errors
  std::string how_shown = {};      ///< description of an image made of bands

  size_t film_channels() const { return shown.size(); }
  bool are_bands() const { return !bands.empty(); }
  /// Index of luminance; colours only.
  size_t luminance() const { return kFirst + film_channels(); }
};

/// Returns the channels of a scene's film. Colours: red, green, blue and luminance in linear SMPTE-C. Bands: radiance
/// over the radiance of a white diffuse surface of luminance 1 under all lights of the scene together. Throws
/// InputError for a band in which the lights emit nothing.
ChannelList channels_of(const Scene& scene);

/// Returns the number of samples of a pixel after which every channel has been sampled.
uint64_t samples_for_all_channels(const Scene& scene);

/// Whether two films have the same channels.
bool same_channels(const ChannelList& a, const ChannelList& b);

}  // namespace frond::compare
