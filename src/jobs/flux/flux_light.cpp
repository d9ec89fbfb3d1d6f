#include "jobs/flux/flux_light.h"

#include "radiometry/horizontal_irradiance.h"
#include "radiometry/radiometer_scene.h"
#include "spectra/named.h"
#include "spectra/spd_file.h"

namespace frond {
namespace {

/// Light of photons, which need a unit, where the scene's has none.
constexpr std::string_view kOfPhotons = "solar-am1.5-global";

/// Throws InputError unless --irradiance is in W/(m2 nm).
void check_physical(const SceneDescription& description, const JobRun& run) {
  const std::string name = run.args.text("irradiance");
  if (name != kOfScene) {
    if (!name.empty() && !is_spectrum_file(name, name) && !name.starts_with("solar-"))
      fail({}, "{}: \"{}\" is not in W/(m2 nm): a file in this unit is needed, or one of the spectra solar-*",
           run.args.spelled("irradiance"), name);
    return;
  }
  if (const ParsedPlugin* light = light_without_unit(description)) {
    const ParsedParam* scaled = find_param(light->params, "illuminance");
    fail(scaled ? scaled->where : light->where,
         "{} {}: this light is scaled to {} and has no unit; take LightSource \"sky\" without \"illuminance\", or "
         "name a spectrum in W/(m2 nm)",
         run.args.spelled("irradiance"), kOfScene, scaled ? "an illuminance" : "luminance 1");
  }
}

}  // namespace

SpectrumPtr named_irradiance(const JobRun& run) {
  const std::string light = run.args.text("irradiance");
  if (light.empty() || light == kOfScene) return nullptr;
  return named_or_read_spectrum(light, light, {});
}

std::string photon_light_name(const JobRun& run, const SceneDescription& description) {
  if (run.args.given("irradiance")) return run.args.text("irradiance");
  return std::string(light_without_unit(description) ? kOfPhotons : kOfScene);
}

std::optional<PhotonWeights> photon_weights(const JobRun& run, const SceneDescription& description,
                                            const FluxMeter& meter, const SpectrumPtr& irradiance) {
  const auto bands = meter.scene().wavelengths().bands();
  if (!PhotonWeights::cover_par(bands)) return {};
  if (const ParsedPlugin* light = light_without_unit(description); light && has_lamps(meter.scene().lights())) {
    run.log().warn(light->where,
                   "this light has no unit, so that photons are unknown: give it \"radiantpower\" (W) or "
                   "\"photonflux\" (umol/s)");
    return {};
  }
  check_physical(description, run);
  if (irradiance) return PhotonWeights::from_irradiance(bands, *irradiance);
  if (photon_light_name(run, description) == kOfScene)
    return PhotonWeights::from_irradiance(
        bands, *horizontal_irradiance(meter.scene(), {400, 700}, run.session().pool(), meter.target_area()));
  return PhotonWeights::from_irradiance(bands, *named_spectrum(kOfPhotons, {}));
}

void explain_no_photons(const JobRun& run, std::span<const Band> bands) {
  if (!bands.front().response.empty()) return;
  const std::string needed =
      fmt::format("no PAR: bands from 400 to 700 nm are needed, in steps of at most 50 nm ({} 400:700:20)",
                  run.args.spelled("wavelengths"));
  if (run.args.given("irradiance"))
    run.log().warn({},
                   fmt::format("{} has no effect on single wavelengths; {}", run.args.spelled("irradiance"), needed));
  else
    run.log().info(needed);
}

void warn_of_no_unit(const JobRun& run, const SceneDescription& description) {
  const std::string name = run.args.text("irradiance");
  const bool is_of_scene = name.empty() || name == kOfScene;
  if (is_of_scene ? !light_without_unit(description) : is_spectrum_file(name, name) || name.starts_with("solar-"))
    return;
  run.log().warn(
      {},
      fmt::format("{} has no unit: columns in W/m2 and umol/(m2 s) are in units of the scene, shares and "
                  "ratios are right; LightSource \"sky\", or {} with a spectrum in W/(m2 nm), has one",
                  is_of_scene ? "the light of the scene" : "the irradiance " + name, run.args.spelled("irradiance")));
}

}  // namespace frond
