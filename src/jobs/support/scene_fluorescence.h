#pragma once

#include "core/fluorescence.h"
#include "jobs/record/job.h"
#include "radiometry/brf.h"
#include "radiometry/fluorescence_flux.h"

/// Fluorescence of a scene, for the jobs brf and flux (docs/fluorescence.md).
namespace frond {

/// Returns --fluorescence; `excludes`: parameters of the job that have no meaning beside it.
constexpr JobParam scene_fluorescence_param(std::string_view doc, std::string_view excludes) {
  return JobParam("fluorescence", ArgumentKind::flag, doc, {.decides = true, .excludes = excludes});
}
inline constexpr JobParam kSceneEmissionParam(
    "emission", ArgumentKind::numbers, "Wavelengths of emission, with --fluorescence.",
    {.default_value = "685,740,760", .unit = "nm", .range = kEmission_nm, .decides = true, .needs = "fluorescence"});

/// Returns --emission as wavelengths of a scene, a PluginText of `bands`.
std::string emission_text(const Arguments& args);

/// Returns the result of `frond brf --fluorescence`: radiance by view, and the escape fraction, for which light paths
/// are traced.
Result fluorescence_brf_result(const JobRun& run, const BrfMeter& meter, const BrfMeasurement& measurement,
                               const RenderControl& control);

/// Returns the result of `frond flux --fluorescence`: photons by their fate.
Result fluorescence_flux_result(const JobRun& run);

}  // namespace frond
