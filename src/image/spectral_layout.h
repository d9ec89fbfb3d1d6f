#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/wavelengths.h"
#include "image/image_file.h"

namespace frond {

// Channel names and attributes of the layout of Fichet, Pacanowski and Wilkie 2021, "An OpenEXR Layout for Spectral
// Images".

/// Returns the name of a channel of radiance, such as "S0.551,000000nm".
std::string spectral_channel(double nm);
/// Returns the name of the channel with its variance, such as "variance.551,000000nm".
std::string variance_channel(double nm);
/// Returns the wavelength (nm) in the name of a channel of radiance; nothing for other names and for units other than
/// nm.
std::optional<double> wavelength_of_channel(const std::string& name);

/// Returns the wavelengths (nm) of an image's bands in ascending order; empty if it is not a spectral image.
std::vector<double> bands_of(const Image& image);

/// Returns the colour space of the preview channels R, G and B, which a spectral image contains for viewers without
/// support of the layout; empty if it has no preview, because the bands do not cover the visible.
std::string preview_space(std::span<const Band> bands);
/// Returns the header attributes that the layout requires: its version, the units, and the sensitivity of each channel
/// that has a response.
std::map<std::string, std::string> spectral_attributes(std::span<const Band> bands);

/// Returns a false-colour image: R, G and B are the bands nearest to the three wavelengths `nm`, scaled so that a white
/// surface in equal-energy light of luminance 1 is 1. Throws InputError, which lists the bands, if none lies within 10
/// nm of a wavelength.
Image false_color_image(const ImageFile& file, const std::string& path, std::span<const double> nm);

}  // namespace frond
