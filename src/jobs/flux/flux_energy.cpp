#include "jobs/flux/flux_energy.h"

#include "core/wavelengths.h"
#include "leaf/tissue/constants.h"
#include "radiometry/horizontal_irradiance.h"
#include "radiometry/radiometer_scene.h"
#include "scene/leaf_models.h"
#include "spectra/named.h"
#include "spectra/spd_file.h"
#include "system/atomic_file.h"

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

/// Returns the wavelengths for which optics are known.
Interval optics_range(const JobRun& run, const SceneDescription& description) {
  const auto given = run.args.numbers("optics-range");
  if (given.empty()) {
    const auto leaves = leaf_flags(description, run.session().registry());
    return std::ranges::find(leaves, 1) == leaves.end() ? kWavelengthRange_nm : leaf::kConstantsRange_nm;
  }
  const Interval nm{given[0], given[1]};
  if (!(nm.max - nm.min >= 1 && kWavelengthRange_nm.contains(nm.min) && kWavelengthRange_nm.contains(nm.max)))
    fail({}, "{}: {:g} to {:g} nm is not a range within 300 to 2500 nm", run.args.spelled("optics-range"), nm.min,
         nm.max);
  return nm;
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

/// The description is needed: a leaf model has constants from 360 nm on, other materials have data of their own.
void set_bands(const JobRun& run, const SceneDescription& description, FluxRequest& request) {
  const std::vector<NamedRange> ranges = band_ranges(run.args);
  const Interval optics = optics_range(run, description);
  request.wavelengths = bands_text(ranges, optics);
  request.ranges_nm.clear();
  for (const NamedRange& range : ranges) {
    request.ranges_nm.push_back(range.nm);
    if (!optics.contains(range.nm.min) || !optics.contains(range.nm.max))
      run.log().info(
          fmt::format("band {} has light beyond {:g} to {:g} nm, for which optics are known: it meets those at "
                      "the ends",
                      range.name, optics.min, optics.max));
  }
}

void explain_no_leaves(const JobRun& run, const EnergyBudget& energy) {
  if (energy.leaves.absorbed.empty())
    run.log().info(fmt::format("no fAPAR, no sunlit leaves: no material is a leaf model; {} names the leaves",
                               run.args.spelled("material")));
  else if (energy.sunlit.absorbed.empty())
    run.log().info("no sunlit leaves: the scene has no sun above the horizon, or several");
}

/// Albedo and fAPAR are single values of JSON, too, since they are what is asked for most.
Result energy_result(const FluxMeasurement& measurement, bool all_rows) {
  const EnergyBudget& energy = *measurement.energy;
  Result result{.tables = {energy_table(measurement)}};
  result.text = to_text(result.tables[0]);
  for (size_t band = 0; band < energy.reflected.size() && !measurement.has_lamps; ++band) {
    const MeanError& albedo = energy.reflected[band].energy.total;
    result.facts.push_back({"albedo_" + measurement.bands[band].name, albedo.mean});
    result.facts.push_back({"albedo_" + measurement.bands[band].name + "_se", albedo.standard_error});
  }
  if (const auto share = fapar(measurement)) {
    result.facts.push_back({"fapar", share->mean});
    result.facts.push_back({"fapar_se", share->standard_error});
  }
  if (energy.leaves.absorbed.empty()) return result;
  result.tables.push_back(leaf_table(measurement, all_rows));
  result.text += '\n' + to_text(result.tables[1]);
  return result;
}

/// A list, because a PlannedOutput cannot be moved. Tables that the measurement turns out not to have, as of leaves,
/// are planned too.
std::list<PlannedOutput> planned_tables(const Arguments& args) {
  std::list<PlannedOutput> planned;
  const std::string csv = args.text("csv");
  if (csv.empty() || csv == "-") return planned;
  // Name, and what it is in messages. The first table of the result is the file of --csv itself.
  std::vector<std::pair<const char*, const char*>> tables;
  const bool by_energy = args.given("bands");
  if (args.given("by")) tables.emplace_back(by_energy ? "energy" : "flux", by_energy ? "energy" : "shares");
  if (by_energy) tables.emplace_back("leaves", "leaves");
  for (const auto& [name, what] : tables) {
    const std::string path = csv_beside(csv, name);
    planned.emplace_back(fmt::format("the table of {} beside {}", what, args.spelled("csv")), path);
    check_replaceable(path);
  }
  return planned;
}

void write_ply(const JobRun& run, const FluxMeasurement& measurement, const Organs& organs) {
  if (!run.args.given("ply")) return;
  const size_t others = write_organ_ply(binary_file_of(run.args, "ply"), measurement, organs);
  if (others > 0)
    run.log().warn({}, fmt::format("{}: {} surfaces are left out, since they are no meshes of triangles",
                                   run.args.spelled("ply"), others));
}

}  // namespace frond
