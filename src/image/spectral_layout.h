#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/wavelengths.h"
#include "image/image_file.h"

namespace frond {

// Channel names and attributes of the layout of Fichet, Pacanowski and Wilkie 2021, "An OpenEXR Layout for Spectral
// Images".

// A band that a sensor's response defines has a name, which stands in place of the wavelength: "S0.nir",
// "variance.nir".

/// Returns the buckets of a film: equal intervals of a range, named after their centres as by pbrt-v4: "374,688nm".
std::vector<Band> bucket_bands(int count, Interval range_nm);

/// Returns the name of a channel of radiance, such as "S0.551,000000nm".
std::string spectral_channel(double nm);
/// Returns the name of a band's channel of radiance.
std::string spectral_channel(const Band& band);
/// Returns the name of the channel with its variance, such as "variance.551,000000nm".
std::string variance_channel(const Band& band);
/// Returns the wavelength (nm) in the name of a channel of radiance; nothing for other names and for units other than
/// nm.
std::optional<double> wavelength_of_channel(const std::string& name);

/// Returns the bands of an image as false_color_image takes them, wavelengths (nm) ascending before names; empty if it
/// is not a spectral image.
std::vector<std::string> bands_of(const Image& image);

/// Returns the colour space of the preview channels R, G and B, which a spectral image contains for viewers without
/// support of the layout; empty if it has no preview, because the bands do not cover the visible.
std::string preview_space(std::span<const Band> bands);
/// Returns the header attributes that the layout requires: its version, the units, and the sensitivity of each channel
/// that has a response.
std::map<std::string, std::string> spectral_attributes(std::span<const Band> bands);

/// Returns a false-colour image: R, G and B are the three `bands`, scaled so that a white surface in equal-energy light
/// of luminance 1 is 1. A band is the name of one of the image's, or a wavelength (nm), which stands for the nearest
/// one. Throws InputError, which lists the bands, for a name that the image lacks and if none lies within 10 nm of a
/// wavelength.
Image false_color_image(const ImageFile& file, const std::string& path, std::span<const std::string> bands);

}  // namespace frond
