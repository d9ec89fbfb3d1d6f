#pragma once

#include <string>
#include <vector>

#include "core/wavelengths.h"
#include "leaf/table/depth_map.h"
#include "leaf/table/table_axes.h"

namespace frond {

/// Wavelengths (nm) at which a leaf's table is made for a render: those that every path carries, lane by lane, or,
/// where they vary, ascending ones to interpolate between: those of a list, or steps of 2.5 nm. At that step the error
/// of a leaf's shares stays below 8e-4, at the red edge; its mean is 5e-5.
std::vector<double> table_wavelengths(const WavelengthStrategy& strategy);

/// Of a table that a file holds at the wavelengths `in_file_nm`: those at which a render needs it, lane by lane, or the
/// file's own, ascending. One wavelength stands for all; else throws InputError at `where` where the file, `name`, does
/// not reach as far as the render.
std::vector<double> file_wavelengths(std::vector<double> in_file_nm, const WavelengthStrategy& strategy,
                                     const Location& where, std::string_view name);

/// All of a strategy that a table made or read for it depends on, for the key of what materials share.
std::string wavelengths_key(const WavelengthStrategy& strategy);

/// As `table_wavelengths` where the table has the optical depth for an axis, so that the refractive indices alone
/// change with the wavelength: 40 nm apart.
std::vector<double> index_wavelengths(const WavelengthStrategy& strategy);

/// All depths that a leaf's textures can give at these wavelengths, in steps of at most `step` of their logarithm.
leaf::DepthAxis depth_axis(const leaf::DepthMap& depth, const WavelengthStrategy& strategy, double step);

}  // namespace frond
