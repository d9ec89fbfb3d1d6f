#pragma once

#include "core/image.h"
#include "render/film/film.h"
#include "spectra/color/color_management.h"
#include "study/compare/channels.h"

namespace frond::compare {

/// A film's means: every channel of `list` but that of all together, in its unit.
Image image_of(const Film& film, const Scene& scene, const ChannelList& list, const ColorManager& colors);

/// What people see of such an image: red, green and blue of linear SMPTE-C.
Image shown(const Image& image, const ChannelList& list);

/// Half and half.
Image mean_of(const Image& a, const Image& b);

/// Whole stops by which a display has to brighten it for people to see much: the brightest tenth, as far as it is lit,
/// comes to lie above 0.3. 0 for a black image.
double fitting_exposure(const Image& shown);

/// What people see, as a display shows it after brightening by so many stops.
Image display_image(const Image& shown, double exposure_stops, const ColorManager& colors);

/// Share of leaf in each pixel.
std::vector<float> leaf_mask(const Film& film);

}  // namespace frond::compare
