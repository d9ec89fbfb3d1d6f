#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/wavelengths.h"
#include "image/image_file.h"

namespace frond {

/// Name of a channel of radiance in the layout of Fichet, Pacanowski and Wilkie 2021, "An OpenEXR Layout for Spectral
/// Images": S0.551,000000nm.
std::string spectral_channel(double nm);
/// Of its variance: variance.551,000000nm.
std::string variance_channel(double nm);
/// The wavelength (nm) that such a name says; nothing for other names, and for other units than nm.
std::optional<double> wavelength_of_channel(const std::string& name);

/// Wavelengths (nm) of an image's bands in ascending order; none where it is no spectral image.
std::vector<double> bands_of(const Image& image);

/// Colour space of the R G B that a spectral image has for programs that know no spectra; empty: it has none, for the
/// bands do not cover the visible.
std::string preview_space(std::span<const Band> bands);
/// What the layout asks of the header: its version, units, and each channel's sensitivity where it has one.
std::map<std::string, std::string> spectral_attributes(std::span<const Band> bands);

/// Three bands of an image of that layout as R G B: those nearest to `nm`, scaled so that a white surface in
/// equal-energy light of luminance 1 is 1. Throws InputError that lists the bands where none lies within 10 nm.
Image false_color_image(const ImageFile& file, const std::string& path, std::span<const double> nm);

}  // namespace frond
