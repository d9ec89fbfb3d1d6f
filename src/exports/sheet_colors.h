#pragma once

#include <array>
#include <string>
#include <vector>

#include "exports/format.h"
#include "spectra/matrix3.h"

namespace frond {

/// Returns 380 to 780 nm in steps of 10 nm: the wavelengths of a colour.
std::vector<double> visible_wavelengths();

/// Returns the weight of each wavelength in X (0), Y (1) or Z (2) under D65, for values that are linear between the
/// wavelengths and constant beyond. The weights sum to 1: X, Y and Z are relative to white.
std::vector<double> d65_weights(size_t which, const std::vector<double>& nm);

/// R and T of one side as linear red, green and blue, between 0 and 1. Their sums are at most 1.
struct SideColors {
  Triple reflected, transmitted;
};

/// R and T of a sheet in three channels: what a Lambertian material of another program represents.
struct SheetColors {
  std::string light;                             ///< what the channels are
  std::array<SideColors, 2> near_normal{};       ///< front and back, light at 8 degrees as in a spectrophotometer
  std::array<SideColors, 2> at_grazing_angle{};  ///< the same at 75 degrees
};

/// Measures R and T of the material. By default the channels are linear sRGB under D65 (CIE 1931); three wavelengths
/// are red, green and blue themselves, and more the samples of the colour. Logs the values, what a Lambertian material
/// loses of them, and colours that had to be limited. `keeps_sides`: whether the format has both sides. Throws
/// InputError as ExportedBsdf does.
SheetColors sheet_colors(const ExportMaterial& material, const ExportRequest& request, bool keeps_sides);

/// Throws InputError for one or two wavelengths, and for more than three that do not ascend.
void check_sheet_colors(const ExportRequest& request);

/// Colours of a material that transmits one share of the light, the same in all channels, and reflects the rest:
/// R = (1 - share) reflected, T = share transmitted.
struct SharedColors {
  double share;
  Triple reflected, transmitted;
};

/// Returns the colours for R and T. The share is the largest T, so that a channel of `transmitted` is 1. Where R of one
/// channel and T of another exceed 1 together, R is lowered, and a warning states by how much.
SharedColors shared_colors(const SideColors& side, const Log& log);

}  // namespace frond
