#pragma once

#include <string>
#include <vector>

#include "core/wavelengths.h"
#include "leaf/table/depth_map.h"
#include "leaf/table/table_axes.h"

namespace frond {

/// Returns the wavelengths (nm) of a leaf's table for a render. If every path carries the same wavelengths: these, lane
/// by lane. Else ascending wavelengths to interpolate between: the strategy's list, or steps of 2.5 nm. With this step
/// the error of a leaf's shares stays below 8e-4, at the red edge; its mean is 5e-5.
std::vector<double> table_wavelengths(const WavelengthStrategy& strategy);

/// Returns the wavelengths at which a render uses a table from a file with wavelengths `in_file_nm`: the render's, lane
/// by lane, or the file's own, ascending. A file of one wavelength is used at all of them. Throws InputError at `where`
/// if the file, `name`, does not cover the render's wavelengths.
std::vector<double> file_wavelengths(std::vector<double> in_file_nm, const WavelengthStrategy& strategy,
                                     const Location& where, std::string_view name);

/// Returns everything of a strategy that a table depends on, for the key of data that materials share.
std::string wavelengths_key(const WavelengthStrategy& strategy);

/// As `table_wavelengths` for a table over optical depth: only the refractive indices change with the wavelength, so
/// the step is 40 nm.
std::vector<double> index_wavelengths(const WavelengthStrategy& strategy);

/// Step of the natural logarithm of depth in tables of reflectance and transmittance. With `index_wavelengths`, errors
/// of shares stay below 4e-4, their mean below 3e-5.
inline constexpr double kSharesDepthStep = 0.1;

/// Axis over all depths that a leaf's textures can give at these wavelengths, in steps of at most `step` of their
/// logarithm.
leaf::DepthAxis depth_axis(const leaf::DepthMap& depth, const WavelengthStrategy& strategy, double step);

}  // namespace frond
