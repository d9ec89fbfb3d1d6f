#include "radiometry/flux.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "jobs/support/radiometry.h"
#include "jobs/support/refine.h"
#include "jobs/support/time_limit.h"
#include "radiometry/horizontal_irradiance.h"
#include "radiometry/photons.h"
#include "spectra/named.h"
#include "spectra/spd_file.h"

namespace frond {

// `frond flux`: light budget of a scene: reflected, transmitted and absorbed shares, by material or by instance
// (docs/radiometry.md).

namespace {

using enum ArgumentKind;

constexpr std::string_view kBy[] = {"instance"};
constexpr JobParam kParams[] = {
    kSceneParam,
    kRadiometryWavelengthsParam,
    kTargetParam,
    kPeriodParam,
    JobParam("paths", count, "Number of light paths; at least 32 for each wavelength are traced.",
             {.default_value = "1e6", .range = kCounts}),
    rms_param(
        "Absolute standard error, as a share of the incident light (0.001 is 0.1 % of it): stop when the RMS of the "
        "standard errors of all reflected and absorbed shares is below this; --paths is then not used."),
    kTimeLimitParam,
    JobParam("by", text, "Measure the absorption of each instance of an object, one row each.",
             {.choices = kBy, .decides = true}),
    JobParam("irradiance", text,
             "Spectral irradiance of a horizontal plane, by which bands with responses are weighted, and photons: name "
             "of a spectrum, a spectrum file, or scene: that of the scene's lights. By default bands have that of the "
             "scene, and photons, which need a unit, solar-am1.5-global.",
             {.type = "SPECTRUM", .unit = "W/(m2 nm)", .decides = true}),
    kSwapParam,
    kSeedParam,
    kIgnoreUnsupportedParam,
    kStrictParam,
    kCsvParam,
    kJsonParam,
    kCheckpointParam,
    kResumeParam,
};

/// One quantity of the light budget, by band.
struct Row {
  std::string quantity, material;
  const std::vector<MeanError>& shares;
};

/// Returns the rows of the budget, in the order of the tables.
std::vector<Row> rows_of(const FluxMeasurement& measurement) {
  std::vector<Row> rows{{"reflected", "", measurement.reflected}, {"transmitted", "", measurement.transmitted}};
  for (const FluxMeasurement::OfMaterial& m : measurement.materials) rows.push_back({"absorbed", m.name, m.absorbed});
  rows.push_back({"sum", "", measurement.sum});
  for (const FluxMeasurement::OfMaterial& m : measurement.materials) rows.push_back({"incident", m.name, m.incident});
  for (const FluxMeasurement::OfMaterial& m : measurement.materials)
    rows.push_back({"uncollided", m.name, m.uncollided});
  return rows;
}

/// Returns the share of PAR photons. Its standard error is an upper bound, because bands share their paths.
MeanError share_of_photons(std::span<const MeanError> shares, const PhotonWeights& photons) {
  MeanError sum;
  for (size_t band = 0; band < shares.size(); ++band) {
    if (photons.weights[band] == 0) continue;  // an error may be unknown there
    sum.mean += photons.weights[band] * shares[band].mean;
    sum.standard_error += photons.weights[band] * shares[band].standard_error;
  }
  return sum;
}

/// Table with one row for each quantity and band. Rows of PAR photons have no wavelength.
Table share_table(const FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons) {
  Table table{"flux"};
  const auto add = [&table](const Row& row, const Band& band, const MeanError& share) {
    table.add("quantity", row.quantity);
    table.add("material", row.material);
    add_band(table, band);
    table.add("share", share);
  };
  for (const Row& row : rows_of(measurement)) {
    for (size_t band = 0; band < measurement.bands.size(); ++band) add(row, measurement.bands[band], row.shares[band]);
    if (photons) add(row, {std::numeric_limits<double>::quiet_NaN()}, share_of_photons(row.shares, *photons));
  }
  if (photons) std::ranges::find(table.columns, "wavelength_nm", &Column::name)->missing = "PAR";
  return table;
}

/// Text table with one row for each quantity and one column for each band.
std::string share_text(const FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons) {
  Table table{"flux"};
  for (const Row& row : rows_of(measurement)) {
    table.add("share", row.quantity);
    table.add("material", row.material);
    if (photons) table.add("PAR photons", share_of_photons(row.shares, *photons));
    for (size_t band = 0; band < measurement.bands.size(); ++band)
      table.add(heading_of(measurement.bands[band]), row.shares[band]);
  }
  return to_text(table);
}

/// Returns the column of an instance's absorption in a band: absorbed_550, absorbed_nir.
std::string column_of(const Band& band) {
  return "absorbed_" + (band.name.empty() ? fmt::format("{:g}", band.nm) : band.name);
}

/// Table with one row for each instance: area, absorbed photon flux (umol / (m2 s)), and absorbed shares of the
/// incident light. It is built by whole columns, because there may be 1e8 instances.
Table instance_table(const FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons) {
  const size_t bands = measurement.bands.size(), count = measurement.areas.size();
  Table table{"instances"};
  const auto add = [&](const std::string& name, const auto& value) {
    std::vector<double> values(count);
    for (size_t i = 0; i < count; ++i) values[i] = value(i);
    table.columns.push_back({name, std::move(values)});
  };
  const auto add_measured = [&](const std::string& name, const auto& value) {
    add(name, [&](size_t i) { return value(i).mean; });
    add(name + "_se", [&](size_t i) { return value(i).standard_error; });
  };
  add("instance", [](size_t i) { return double(i + 1); });
  add("area", [&](size_t i) { return double(measurement.areas[i]); });
  if (photons)
    add_measured("par_umol_m2_s", [&](size_t i) {
      const MeanError share = share_of_photons(std::span(measurement.by_instance).subspan(i * bands, bands), *photons);
      const double factor = photons->incident * measurement.target_area / double(measurement.areas[i]);
      return MeanError{share.mean * factor, share.standard_error * factor};
    });
  for (size_t band = 0; band < bands; ++band)
    add_measured(column_of(measurement.bands[band]),
                 [&](size_t i) { return measurement.by_instance[i * bands + band]; });
  return table;
}

/// Returns a callback that writes a checkpoint if the last one is older than the interval.
std::function<void()> checkpoint_writer(const JobRun& run, const FluxMeter& meter, const KeptFile& kept) {
  using Clock = std::chrono::steady_clock;
  const std::chrono::duration<double> interval(checkpoint_seconds(run.args));
  return [&run, &meter, &kept, interval, last = Clock::now()]() mutable {
    if (Clock::now() - last < interval) return;
    const UnstoppableScope whole;
    try {
      meter.save(kept.checkpoint());
    } catch (const InputError& error) {
      run.log().warn({}, fmt::format("no checkpoint was written; the measurement continues: {}", error.what()));
    }
    last = Clock::now();
  };
}

/// Returns nullopt if the measurement was stopped. `kept` may be nullptr.
std::optional<FluxMeasurement> measure(const JobRun& run, const RenderControl& control, FluxMeter& meter,
                                       const KeptFile* kept) {
  // A refinement starts with few paths and doubles them.
  constexpr uint64_t kFirst = 1 << 16;
  const double rms = run.args.real("rms");
  // As in the BRF, each band needs some paths for its standard error.
  constexpr uint64_t kLeast = 32;
  const uint64_t least = kLeast * meter.scene().wavelengths().bands().size();
  const RefineLimits limits{std::max(least, rms > 0 ? kFirst : uint64_t(run.args.count("paths"))), uint64_t{1} << 40,
                            rms};
  std::function<void()> checkpoint;
  if (kept) {
    if (const auto path = kept->found(run.args.flag("resume"))) meter.resume(*path);
    checkpoint = checkpoint_writer(run, meter, *kept);
  }
  std::optional<FluxMeasurement> measurement;
  const RefineEnd end = refine(
      limits, meter.paths(), control,
      [&](uint64_t paths) {
        measurement.reset();
        if (meter.paths() < paths) meter.trace(paths - meter.paths(), run.session().pool(), control, checkpoint);
      },
      [&] { return measurement.emplace(meter.read()).error(); });
  if (end != RefineEnd::stopped && meter.paths() == 0)
    fail(scene_file(run.args), "{}: the time limit ended before any light path was traced",
         run.args.spelled("time-limit"));
  if (kept) kept->keep(end != RefineEnd::stopped, false, [&meter](const auto& path) { meter.save(path); });
  if (end == RefineEnd::stopped) return {};
  return measurement ? std::move(measurement) : meter.read();
}

/// The value of --irradiance for that of the scene's lights.
constexpr std::string_view kOfScene = "scene";
/// Light of photons, which need a unit, unless --irradiance names another.
constexpr std::string_view kOfPhotons = "solar-am1.5-global";

/// Returns the spectrum that --irradiance names; nullptr if it is not given, and for that of the scene.
SpectrumPtr named_irradiance(const JobRun& run) {
  const std::string light = run.args.text("irradiance");
  if (light.empty() || light == kOfScene) return nullptr;
  return named_or_read_spectrum(light, light, {});
}

/// Throws InputError unless --irradiance is in W/(m2 nm). The light sky alone keeps the unit of its data; its
/// illuminance has none either.
void check_physical(const SceneDescription& description, const JobRun& run) {
  const std::string name = run.args.text("irradiance");
  if (name != kOfScene) {
    if (!name.empty() && !is_spectrum_file(name, name) && !name.starts_with("solar-"))
      fail({}, "{}: \"{}\" is not in W/(m2 nm): a file in this unit is needed, or one of the spectra solar-*",
           run.args.spelled("irradiance"), name);
    return;
  }
  for (const auto& [light, _] : description.lights) {
    const ParsedParam* scaled = find_param(light.params, "illuminance");
    if (light.name != "sky" || scaled)
      fail(scaled ? scaled->where : light.where,
           "{} {}: this light is scaled to {} and has no unit; take LightSource \"sky\" without \"illuminance\", or "
           "name a spectrum in W/(m2 nm)",
           run.args.spelled("irradiance"), kOfScene, scaled ? "an illuminance" : "luminance 1");
  }
}

/// Returns the weights of bands in the PAR photon flux; nullopt if the bands do not cover 400 to 700 nm. Throws as
/// check_physical does. `irradiance`: as named_irradiance returns it.
std::optional<PhotonWeights> photon_weights(const JobRun& run, const SceneDescription& description,
                                            const FluxMeter& meter, const SpectrumPtr& irradiance) {
  const auto bands = meter.scene().wavelengths().bands();
  if (!PhotonWeights::are_covered_by(bands)) return {};
  check_physical(description, run);
  if (irradiance) return PhotonWeights::of(bands, *irradiance);
  if (run.args.text("irradiance") == kOfScene)
    return PhotonWeights::of(bands, *horizontal_irradiance(meter.scene(), {400, 700}));
  return PhotonWeights::of(bands, *named_spectrum(kOfPhotons, {}));
}

/// Says why there are no photons, and if --irradiance is given, that it has no effect.
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

/// Warns of materials that no path met.
void warn_of_unmet(const JobRun& run, const FluxMeasurement& measurement) {
  std::vector<std::string> unmet;
  for (const FluxMeasurement::OfMaterial& m : measurement.materials)
    if (!m.is_met) unmet.push_back('"' + m.name + '"');
  if (!unmet.empty())
    run.log().warn({},
                   fmt::format("no path met the material{} {}: {} shares are unknown; raise {}, or give a smaller {}",
                               unmet.size() > 1 ? "s" : "", fmt::join(unmet, ", "), unmet.size() > 1 ? "their" : "its",
                               run.args.spelled(run.args.given("rms") ? "rms" : "paths"), run.args.spelled("target")));
}

/// Returns the table of instances. It is printed as CSV unless a file is written, because it may be long.
Result by_instance(const JobRun& run, FluxMeasurement& measurement, const std::optional<PhotonWeights>& photons) {
  const size_t bands = measurement.bands.size(), count = measurement.areas.size();
  // An error is unknown in the bands of which no path was absorbed.
  size_t unmet = 0;
  for (size_t i = 0; i < count; ++i)
    unmet += std::ranges::all_of(std::span(measurement.by_instance).subspan(i * bands, bands),
                                 [](const MeanError& share) { return std::isnan(share.standard_error); });
  if (unmet > 0)
    run.log().warn({}, fmt::format("{} of {} instances met no light path, or absorb none: their errors are unknown; "
                                   "raise {}",
                                   unmet, count, run.args.spelled(run.args.given("rms") ? "rms" : "paths")));
  Result result;
  result.tables.push_back(instance_table(measurement, photons));
  measurement.by_instance = {};
  if (run.args.given("csv") || run.args.given("json")) return result;
  result.text = to_csv(result.tables[0], {});
  result.is_requested = true;
  return result;
}

/// The job: traces light paths until the requested number or error is reached, with checkpoints.
Result flux(const JobRun& run) {
  std::optional<KeptFile> kept;
  if (const auto names = kept_names_of(run.args)) kept.emplace(*names, run.control.stop, run.log());
  const SpectrumPtr irradiance = named_irradiance(run);
  const bool is_by_instance = run.args.text("by") == "instance";
  if (!is_by_instance) warn_if_nothing_is_kept(run);
  const FluxRequest request{.target = target_of(run.args),
                            .period = period_of(run.args),
                            .wavelengths = wavelengths_text(run.args),
                            .irradiance = irradiance,
                            .irradiance_name = run.args.text("irradiance"),
                            .by_instance = is_by_instance};
  const RenderControl control = run.control_until(run.args.real("time-limit"));
  std::optional<PhotonWeights> photons;
  const auto load = [&] {
    const SceneDescription description = described_scene(run);
    auto made = std::make_unique<FluxMeter>(run.session(), description, request);
    photons = photon_weights(run, description, *made, irradiance);
    return made;
  };
  const auto loaded = within_time_limit(run, control, load, [&run] { return scene_file(run.args); });
  FluxMeter& meter = *loaded;
  const auto bands = meter.scene().wavelengths().bands();
  if (!photons) explain_no_photons(run, bands);
  run.context.log().check();
  auto measured = measure(run, control, meter, kept ? &*kept : nullptr);
  if (!measured) {
    if (kept) kept->report_stop();
    return {.stopped = true};
  }
  FluxMeasurement& measurement = *measured;
  const double error = measurement.error();
  warn_of_unmet(run, measurement);
  const bool are_weighted = !bands.front().response.empty();
  const std::string light =
      run.args.given("irradiance") ? run.args.text("irradiance") : std::string(are_weighted ? kOfScene : kOfPhotons);
  Result result =
      is_by_instance ? by_instance(run, measurement, photons) : Result{.text = share_text(measurement, photons)};
  result.tables.push_back(share_table(measurement, photons));
  result.facts = {{"paths", double(measurement.paths)}, {"error", error}, {"target_area", measurement.target_area}};
  if (photons) result.facts.push_back({"par_umol_m2_s", photons->incident});
  if (photons || are_weighted) result.facts.push_back({"irradiance", light});
  run.log().info(
      fmt::format("{} paths; RMS standard error {:.2g}{}", measurement.paths, error,
                  photons ? fmt::format("; incident PAR {:.5g} µmol/(m2 s), irradiance {}", photons->incident, light)
                  : are_weighted ? fmt::format("; bands are weighted by the irradiance {}", light)
                                 : ""));
  warn_of_time_limit(run, measurement.paths, error);
  return result;
}

}  // namespace

extern const JobInfo kFluxJob("flux", "Measure",
                              "Measure the light budget of a scene: reflection, transmission, absorption.",
                              "Reports shares of the incident light by wavelength: reflected, transmitted, and "
                              "absorbed by each material. With wavelengths from 400 to 700 nm, also shares "
                              "of the photons (PAR). The share of a band with a response is that of the light under "
                              "it: the mean weighted by response times irradiance.",
                              kParams, SessionUse::all, flux);

}  // namespace frond
