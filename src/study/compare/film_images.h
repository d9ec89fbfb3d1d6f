#pragma once

#include "core/image.h"
#include "render/film/film.h"
#include "spectra/color/color_management.h"
#include "study/compare/channels.h"

namespace frond::compare {

/// Returns a film's means: every channel of `list` except all together, in its unit.
Image image_of(const Film& film, const Scene& scene, const ChannelList& list, const ColorManager& colors);

/// Returns the displayed colours of such an image: red, green and blue in linear SMPTE-C.
Image shown(const Image& image, const ChannelList& list);

/// Returns the mean of two images.
Image mean_of(const Image& a, const Image& b);

/// Returns the exposure in whole stops at which the brightest tenth of the lit pixels lies above 0.3; 0 for a black
/// image.
double fitting_exposure(const Image& shown);

/// Returns the image as displayed after an exposure change of so many stops.
Image display_image(const Image& shown, double exposure_stops, const ColorManager& colors);

/// Returns the leaf fraction of each pixel, 0 to 1.
std::vector<float> leaf_mask(const Film& film);

}  // namespace frond::compare
