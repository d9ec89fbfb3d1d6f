#pragma once

#include <list>

#include "jobs/flux/energy_tables.h"
#include "jobs/record/common_params.h"
#include "system/file_uses.h"

/// The job flux by energy (--bands): from its arguments to its result.
namespace frond {

/// Sets the bands of --bands, and reports which of their light meets the optics of another wavelength (--optics-range).
void set_bands(const JobRun& run, const SceneDescription& description, FluxRequest& request);
/// Reports which quantities of leaves are not measured, and why.
void explain_no_leaves(const JobRun& run, const EnergyBudget& energy);
/// Returns the tables, single values and text of a measurement by energy, except surfaces and organs. `all_rows`: as
/// leaf_table has it.
Result energy_result(const FluxMeasurement& measurement, bool all_rows);
/// Plans the files of tables beside that of --csv, so that they are refused before the measurement if they cannot be
/// written or would replace an input.
std::list<PlannedOutput> planned_tables(const Arguments& args);
/// Writes --ply if it is given. Warns of shapes that are no meshes.
void write_ply(const JobRun& run, const FluxMeasurement& measurement, const Organs& organs);

}  // namespace frond
