#pragma once

#include "instruments/flip.h"
#include "render/film.h"
#include "spectra/color_management.h"
#include "study/compare/channels.h"

namespace frond::compare {

/// Pixels channel by channel, rows from the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::vector<float>> channels;
};

/// A film's means: every channel of `list` but that of all together, in its unit.
Picture picture_of(const Film& film, const Scene& scene, const ChannelList& list, const ColorManager& colors);

/// What people see of such a picture: red, green and blue of linear SMPTE-C.
Picture shown(const Picture& picture, const ChannelList& list);

/// Half and half.
Picture mean_of(const Picture& a, const Picture& b);

/// Whole stops by which a display has to brighten it for people to see much: the brightest tenth, as far as it is lit,
/// comes to lie above 0.3. 0 for a black picture.
double fitting_exposure(const Picture& shown);

/// What people see, as a display shows it after brightening by so many stops.
DisplayImage display_image(const Picture& shown, double exposure_stops, const ColorManager& colors);

/// Share of leaf in each pixel.
std::vector<float> leaf_mask(const Film& film);

/// Red, green and blue, pixel by pixel.
std::vector<float> interleaved(const Picture& shown);

}  // namespace frond::compare
