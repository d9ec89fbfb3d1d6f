#pragma once

#include <vector>

#include "core/spectrum.h"

namespace frond {

/// Returns wavelengths (nm), ascending, from range_nm.min to range_nm.max, between which a spectrum is linear, or
/// smooth over the nanometre that they are apart at most: both ends, whole nanometres, and a table's own points. Sums
/// over them do not miss the lines of a lamp.
std::vector<double> points_nm(const Spectrum& spectrum, Interval range_nm);

/// Appends the points of the tables that `spectrum` consists of.
void append_points_nm(const Spectrum& spectrum, std::vector<double>& nm);

/// Sorts the wavelengths, removes duplicates and wavelengths outside of the range, and adds its ends and whole
/// nanometres.
void complete_points_nm(Interval range_nm, std::vector<double>& nm);

}  // namespace frond
