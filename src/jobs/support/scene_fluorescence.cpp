#include "jobs/support/scene_fluorescence.h"

#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "instruments/errors/statistics.h"
#include "jobs/support/radiometry.h"
#include "jobs/support/time_limit.h"
#include "radiometry/radiometer_scene.h"
#include "spectra/wavelengths/radiant.h"

namespace frond {
namespace {

/// Number of a missing value.
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Returns the comment lines of the CSV file. Every result names the emission shape, which decides the ratio of its
/// peaks.
std::vector<std::string> notes_of(const JobRun& run, const FluorescenceFluxMeasurement& flux, bool has_units) {
  std::vector<std::string> notes{fmt::format("frond {}, fluorescence of a scene", FROND_VERSION)};
  for (const std::string& shape : flux.shapes) notes.push_back(fmt::format("emission: {}", shape));
  notes.push_back(fmt::format("seed: {}", run.args.seed("seed")));
  notes.push_back("Light that fluorescence has excited excites no more.");
  if (!has_units) notes.push_back("The light has no unit: W/m2 and mol are units of the scene's light.");
  return notes;
}

/// Warns of a light without a unit, whose fluorescence has none either. Returns whether there is none.
bool check_units(const JobRun& run, const SceneDescription& description) {
  const ParsedPlugin* light = light_without_unit(description);
  if (light)
    run.log().warn(light->where,
                   "this light has no unit, so that fluorescence is in units of the scene's light: LightSource \"sky\" "
                   "without \"illuminance\" has one");
  return !light;
}

/// Units of the columns that count photons.
void document_photons(Table& table) {
  table.document("photons", "photons per incident photon from 400 to 750 nm; of fluorescence per nm of emission, 1/nm");
  table.document("photon_flux", "nmol m-2 s-1, of fluorescence nmol m-2 s-1 nm-1; horizontal area of the target");
  table.document("energy_flux", "mW m-2 nm-1, horizontal area of the target");
}

/// Table of the balance of photons, one row for each quantity and wavelength.
Table balance_table(const FluorescenceFluxMeasurement& m) {
  Table table{"fluorescence"};
  const auto add = [&](const std::string& quantity, const std::string& material, double nm, const MeanError& share) {
    table.add("quantity", quantity);
    table.add("material", material);
    table.add("wavelength_nm", nm);
    table.add("photons", share);
    table.add("photon_flux", scaled(share, 1e3 * m.incident));
    table.add("energy_flux",
              std::isnan(nm) ? MeanError{kNone, kNone} : scaled(share, 1e3 * m.incident * kPhotonEnergy / nm));
  };
  const auto add_all = [&](const std::string& quantity, const std::string& material,
                           const std::vector<MeanError>& shares) {
    for (size_t i = 0; i < shares.size(); ++i) add(quantity, material, m.emission_nm[i], shares[i]);
  };
  add("excited", "", kNone, m.excited);
  add_all("emitted", "", m.emitted);
  add_all("reabsorbed", "", m.reabsorbed);
  add_all("left", "", m.left);
  add_all("upward", "", m.upward);
  add_all("downward", "", m.downward);
  for (const auto& material : m.materials) add_all("absorbed", material.name, material.absorbed);
  table.document(
      "quantity",
      "excited: absorbed by the constituents that emit; emitted: inside surfaces, of these reabsorbed by the "
      "surface itself, or left it; of these upward or downward out of the scene, or absorbed by a material");
  document_photons(table);
  return table;
}

/// Table with one row for each wavelength: the share of the photons that leave the canopy upward.
Table escape_table(const FluorescenceFluxMeasurement& m) {
  Table table{"escape"};
  for (size_t i = 0; i < m.emission_nm.size(); ++i) {
    table.add("wavelength_nm", m.emission_nm[i]);
    table.add("escape", m.escape[i]);
  }
  table.document("escape", "photons that leave the scene upward, over those that leave the surfaces that emit them");
  return table;
}

/// Text with a row for each quantity and a column for each wavelength, in nmol m-2 s-1 nm-1; the last row has no unit.
std::string balance_text(const FluorescenceFluxMeasurement& m) {
  Table table{"fluorescence"};
  const auto add = [&](const std::string& quantity, const std::string& material, const std::vector<MeanError>& shares,
                       double scale) {
    table.add("quantity", quantity);
    table.add("material", material);
    for (size_t i = 0; i < shares.size(); ++i)
      table.add(fmt::format("{:g} nm", m.emission_nm[i]), scaled(shares[i], scale));
  };
  const double nmol = 1e3 * m.incident;
  add("emitted", "", m.emitted, nmol);
  add("reabsorbed", "", m.reabsorbed, nmol);
  add("left", "", m.left, nmol);
  add("upward", "", m.upward, nmol);
  add("downward", "", m.downward, nmol);
  for (const auto& material : m.materials) add("absorbed", material.name, material.absorbed, nmol);
  add("escape", "", m.escape, 1);
  return to_text(table);
}

/// Table with one row for each instance.
Table instance_table(const FluorescenceFluxMeasurement& m, const LoadedScene& loaded, double target_area) {
  Table table{"instances"};
  const std::vector<float> areas = loaded.scene().geometry().areas();
  for (size_t i = 0; i < m.instances.size(); ++i) {
    const auto& one = m.instances[i];
    // Per area of the leaf, one side.
    const double per_area = m.incident * target_area / double(areas[i]);
    table.add("instance", double(i + 1));
    table.add("area", double(areas[i]));
    table.add("excited_umol_m2_s", scaled(one.excited, per_area));
    for (size_t f = 0; f < m.emission_nm.size(); ++f) {
      table.add(fmt::format("emitted_{:g}", m.emission_nm[f]), scaled(one.emitted[f], 1e3 * per_area));
      table.add(fmt::format("left_{:g}", m.emission_nm[f]), scaled(one.left[f], 1e3 * per_area));
    }
  }
  return table;
}

/// Returns the area of the measured rectangle, in scene units squared.
double area_of(const Target& t) { return (t.x1 - t.x0) * (t.y1 - t.y0); }

}  // namespace

std::string emission_text(const Arguments& args) {
  return fmt::format("bands,fluorescence={}", fmt::join(args.numbers("emission"), ","));
}

Result fluorescence_brf_result(const JobRun& run, const BrfMeter& meter, const BrfMeasurement& measurement,
                               const RenderControl& control) {
  // Light paths for the photons that leave the leaves: their standard error is then well below 1 %.
  constexpr uint64_t kPaths = 1 << 16;
  const bool has_units = check_units(run, meter.scene().description());
  FluorescenceFluxMeter light_paths(
      run.session(), described_scene(run),
      {.target = target_of(run.args), .period = period_of(run.args), .emission_nm = run.args.numbers("emission")},
      &meter.scene().scene());
  light_paths.trace(kPaths, run.session().pool(), {.stop = control.stop, .deadline = control.deadline});
  const FluorescenceFluxMeasurement flux = light_paths.read();
  // The table has a row for each view and wavelength, the text a column for each wavelength.
  Table table{"fluorescence"}, text{"fluorescence"};
  for (size_t view = 0; view < measurement.views.size(); ++view) {
    const ViewDirection& direction = measurement.views[view];
    text.add("zenith", direction.zenith_deg);
    text.add("azimuth", direction.azimuth_deg);
    for (size_t band = 0; band < measurement.bands.size(); ++band) {
      const MeanError& radiance = measurement.at(view, band);
      const double nm = measurement.bands[band].nm;
      const MeanError photons = scaled(radiance, nm / kPhotonEnergy);
      table.add("zenith_deg", direction.zenith_deg);
      table.add("azimuth_deg", direction.azimuth_deg);
      table.add("wavelength_nm", nm);
      table.add("radiance", scaled(radiance, 1e3));
      table.add("photon_radiance", scaled(photons, 1e3));
      table.add("escape", divided(scaled(photons, std::numbers::pi), scaled(flux.left[band], flux.incident)));
      text.add(fmt::format("{:g} nm", nm), scaled(radiance, 1e3));
    }
  }
  table.document("radiance", "mW m-2 sr-1 nm-1; columns ending in _se: standard errors");
  table.document("photon_radiance", "nmol m-2 s-1 sr-1 nm-1");
  table.document("escape",
                 "pi times the photon radiance, over the photons that leave the leaves per horizontal area: the escape "
                 "fraction if the radiance were this one in all directions");
  return {.tables = {table, escape_table(flux)},
          .facts = {{"quantity", std::string("fluorescence")},
                    {"has_units", has_units},
                    {"paths", double(measurement.paths)},
                    {"relative_error", measurement.relative_error()}},
          .notes = notes_of(run, flux, has_units),
          .text = fmt::format("fluorescence, {}\n{}\n{}", has_units ? "mW/(m2 sr nm)" : "unit of the light / 1000",
                              to_text(text), to_text(escape_table(flux)))};
}

// Checkpoints are refused by the record: the sums of instances would have to be kept.
Result fluorescence_flux_result(const JobRun& run) {
  const bool is_by_instance = run.args.text("by") == "instance";
  if (run.args.given("by") && !is_by_instance)
    fail({}, "{} measures instances alone: {} instance", run.args.spelled("fluorescence"), run.args.spelled("by"));
  if (!is_by_instance) warn_if_nothing_is_kept(run);
  const RenderControl control = run.control_until(run.args.real("time-limit"));
  const FluorescenceFluxRequest request{.target = target_of(run.args),
                                        .period = period_of(run.args),
                                        .emission_nm = run.args.numbers("emission"),
                                        .by_instance = is_by_instance};
  const auto load = [&] {
    return std::make_unique<FluorescenceFluxMeter>(run.session(), described_scene(run), request);
  };
  const auto meter = within_time_limit(run, control, load, [&run] { return scene_file(run.args); });
  const bool has_units = check_units(run, meter->loaded().description());
  run.context.log().check();
  // As in `flux` of reflected light, each wavelength needs some paths for its standard error.
  constexpr uint64_t kLeast = 32;
  meter->trace(std::max(uint64_t(run.args.count("paths")), kLeast * request.emission_nm.size()), run.session().pool(),
               control);
  if (control.stop.stop_requested()) return {.stopped = true};
  const FluorescenceFluxMeasurement m = meter->read();
  warn_of_time_limit(run, m.paths, m.relative_error());
  run.log().info(fmt::format("{} paths; RMS relative standard error of the photons that escape {:.2f} %", m.paths,
                             100 * m.relative_error()));
  Result result{.tables = {balance_table(m), escape_table(m)},
                .facts = {{"paths", double(m.paths)},
                          {"has_units", has_units},
                          {"incident_umol_m2_s", m.incident},
                          {"excited", m.excited.mean},
                          {"target_area", area_of(meter->target())}},
                .notes = notes_of(run, m, has_units)};
  result.text = fmt::format(
      "fluorescence, nmol/(m2 s nm); incident light from 400 to 750 nm {:.5g} µmol/(m2 s){}\n{}", m.incident,
      std::isnan(m.excited.mean) ? "" : fmt::format(", of which {:.4f} excites", m.excited.mean), balance_text(m));
  if (!is_by_instance) return result;
  result.tables.insert(result.tables.begin(), instance_table(m, meter->loaded(), area_of(meter->target())));
  result.csv_tables = 2;
  if (!run.args.given("csv") && !run.args.given("json")) result.text += '\n' + to_text(result.tables[0]);
  return result;
}

}  // namespace frond
