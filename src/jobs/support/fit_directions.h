#pragma once

#include "jobs/record/job.h"
#include "report/table.h"

namespace frond {

/// Compares a leaf material, given as text such as `leaf,specimen=maize`, with a goniometer table of the file
/// `path` (materials/measured/goniometer_rows.h), row by row. Returns the table "directions": for each kind, incidence
/// and wavelength the mean of f in the file and of the leaf, the RMS difference, and the RMS of the file's standard
/// errors; rows with a projected solid angle count in proportion to it. Throws InputError.
Table compare_directions(const JobRun& run, const std::string& path, const std::string& material);

/// Returns a line for each kind: RMS difference over all incidences and wavelengths, relative to the mean f.
std::string directions_text(const Table& directions);

}  // namespace frond
