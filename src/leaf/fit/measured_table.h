#pragma once

#include <filesystem>
#include <string>

#include "leaf/fit/measured_spectra.h"
#include "leaf/table/table.h"

namespace frond::leaf {

/// A leaf table that holds measured reflectance and transmittance as they are.
struct MeasuredTable {
  Table table;
  std::string warning = {};  ///< what was left out or changed; empty: nothing
};

/// Returns the table of measurements that have R and T. `surface` is the share of the light, in [0, 1], that the table
/// gives to the surface (Rs); it is limited to R. Wavelengths that lack R or T at one of the angles are left out;
/// negative values, which are noise about 0, become 0; where R + T exceeds 1, both are divided by it. Throws InputError
/// with `name` if no wavelength is complete, if a wavelength and angle occurs twice, or if all angles are above 90
/// degrees.
MeasuredTable measured_table(const MeasuredSpectra& spectra, double surface, const std::string& name);

/// Reads a file of either kind: a leaf table, which has its own Rs, or measured spectra. Throws InputError as their
/// readers do, or at `where` if the file cannot be read.
MeasuredTable read_table_or_spectra(const std::filesystem::path& path, const Location& where,
                                    const SpectraMeasurement& how, double surface);

}  // namespace frond::leaf
