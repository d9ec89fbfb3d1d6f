#pragma once

#include <list>
#include <optional>
#include <span>
#include <string>

#include "jobs/flux/energy_tables.h"
#include "jobs/record/common_params.h"
#include "radiometry/photons.h"
#include "system/file_uses.h"

/// The job flux: its light and the unit of it, and its result by energy (--bands).
namespace frond {

/// The value of --irradiance that selects the scene's lights.
inline constexpr std::string_view kOfScene = "scene";

/// Returns the spectrum that --irradiance names; nullptr if it is not given or selects the scene's lights.
SpectrumPtr named_irradiance(const JobRun& run);
/// Returns the name of the light of photons: --irradiance, or the scene's light if it has a unit.
std::string photon_light_name(const JobRun& run, const SceneDescription& description);
/// Returns the weights of bands in the PAR photon flux; nullopt if the bands do not cover 400 to 700 nm, or with a
/// warning if lamps have no unit. Throws InputError unless --irradiance is in W/(m2 nm). `irradiance`: as
/// named_irradiance returns it.
std::optional<PhotonWeights> photon_weights(const JobRun& run, const SceneDescription& description,
                                            const FluxMeter& meter, const SpectrumPtr& irradiance);
/// Says why there are no photons, and if --irradiance is given, that it has no effect.
void explain_no_photons(const JobRun& run, std::span<const Band> bands);
/// Warns that energies have no unit, unless the irradiance is in W/(m2 nm).
void warn_of_no_unit(const JobRun& run, const SceneDescription& description);

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
