#pragma once

#include <optional>
#include <span>
#include <string>

#include "jobs/record/job.h"
#include "radiometry/flux.h"
#include "radiometry/photons.h"

/// The light of the job flux: --irradiance, its unit, and photons.
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

}  // namespace frond
