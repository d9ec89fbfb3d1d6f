#pragma once

#include <array>
#include <span>
#include <vector>

#include "instruments/flip.h"
#include "scene/film.h"
#include "spectra/color_management.h"

namespace frond::compare {

/// The space in which errors are measured.
inline constexpr std::string_view kErrorSpace = "linear SMPTE-C";

/// A film's means, channel by channel: red, green, blue of linear SMPTE-C and luminance.
struct Picture {
  int width = 0, height = 0;
  std::array<std::vector<float>, 4> channels;
};

/// `film_space` is that of the film's channels.
Picture picture_of(const Film& film, std::string_view film_space, const ColorManager& colors);

/// Half and half.
Picture mean_of(const Picture& a, const Picture& b);

/// As a display shows it after brightening by so many stops.
DisplayImage display_image(const Picture& picture, double exposure_stops, const ColorManager& colors);

/// Share of leaf in each pixel.
std::vector<float> leaf_mask(const Film& film);

/// Red, green and blue, pixel by pixel.
std::vector<float> interleaved(const Picture& picture);

}  // namespace frond::compare
