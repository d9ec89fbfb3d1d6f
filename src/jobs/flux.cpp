#include "radiometry/flux.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <list>

#include "jobs/flux/flux_energy.h"
#include "jobs/flux/flux_parts.h"
#include "jobs/flux/flux_tables.h"
#include "jobs/flux/time_series.h"
#include "jobs/support/provenance.h"
#include "jobs/support/radiometry.h"
#include "jobs/support/refine.h"
#include "jobs/support/scene_fluorescence.h"
#include "jobs/support/time_limit.h"
#include "radiometry/horizontal_irradiance.h"
#include "radiometry/instance_errors.h"
#include "radiometry/radiometer_scene.h"

namespace frond {

// `frond flux`: light budget of a scene: reflected, transmitted and absorbed light, as shares or by energy and photons,
// by material or by organ (docs/radiometry.md).

namespace {

using enum ArgumentKind;

constexpr JobParam kFluxParams[] = {
    kSceneParam,
    kRadiometryWavelengthsParam,
    JobParam(
        "bands", text,
        "Measure energy and photons of these bands, direct and diffuse light apart, and sunlit and shaded leaves: "
        "par (400 to 700 nm), nir (700 to 1100 nm), shortwave (300 to 2500 nm), all: these three, or NAME=FIRST:LAST "
        "in nm.",
        {.type = "BANDS", .decides = true, .excludes = "wavelengths"}),
    JobParam(
        "optics-range", numbers,
        "Wavelengths for which the optics of all surfaces are known: light beyond them meets the optics at the ends. "
        "By default 360 to 2500 nm if the scene has leaf models, else all wavelengths of the bands.",
        {.type = "FIRST,LAST", .unit = "nm", .values = 2, .decides = true, .needs = "bands"}),
    JobParam("material", texts,
             "Material whose surfaces count as leaves, by its name in the scene; by default all leaf models.",
             {.type = "NAME", .decides = true, .needs = "bands"}),
    kTargetParam,
    kPeriodParam,
    JobParam(
        "sides", flag,
        "Light also enters through the sides of the box between the target and the bottom of the scene: for plants "
        "that stand alone. Shares remain relative to the light through the target, and may exceed 1.",
        {.decides = true}),
    JobParam("paths", count,
             "Number of light paths, rounded up to an even one; at least 32 for each wavelength are traced.",
             {.default_value = "1e6", .range = kCounts}),
    rms_param(
        "Absolute standard error, as a share of the incident light (0.001 is 0.1 % of it): stop when the RMS of the "
        "standard errors of all reflected and absorbed shares is below this; --paths is then not used."),
    kTimeLimitParam,
    JobParam("by", text,
             "Measure the absorption of each instance of an object, mesh, connected part of a mesh, triangle or "
             "material, one row each; the other tables are then in files beside that of --csv: leaves-flux.csv beside "
             "leaves.csv.",
             {.choices = kOrganKinds, .decides = true}),
    JobParam(
        "instance-error", real,
        "Relative standard error (0.05 or 5%): stop when the median over the instances, or other rows of --by, "
        "is below this, of the PAR photons that each absorbs, or without PAR of the light in the worst band; --paths "
        "is then not used.",
        {.range = {kAboveZero.min, 1}, .relative = true, .needs = "by"}),
    JobParam("irradiance", text,
             "Spectral irradiance of a horizontal plane, by which bands with responses are weighted, and photons: name "
             "of a spectrum, a spectrum file, or scene: that of the scene's lights. By default bands have that of the "
             "scene; photons, which need a unit, have it if all lights are sky, or else solar-am1.5-global.",
             {.type = "SPECTRUM", .unit = "W/(m2 nm)", .decides = true}),
    scene_fluorescence_param(
        "Count the photons of fluorescence instead: excited, emitted, reabsorbed, escaping upward.",
        "wavelengths,bands,sides,rms,instance-error,irradiance,checkpoint,resume,part,merge"),
    kSceneEmissionParam,
    JobParam(
        "times", text,
        "Table of times (CSV): measure the scene under the light of each, with one load of the scene. Columns: time "
        "(2026-06-21T11:00+02:00); latitude and longitude, or sun_zenith and sun_azimuth from north to east; ghi, "
        "dhi, dni (W/m2); any parameter of LightSource \"sky\", or of the scene's only LightSource.",
        {.type = "FILE", .path = PathUse::read, .decides = true, .excludes = "ply,fluorescence"}),
    kSwapParam,
    kSeedParam,
    kIgnoreUnsupportedParam,
    kStrictParam,
    kCsvParam,
    kJsonParam,
    JobParam("ply", text,
             "PLY file to write: meshes whose faces have the light that each row of --by absorbs for each unit of its "
             "area, as properties, and as colours in the first band.",
             {.type = "FILE", .path = PathUse::write, .needs = "bands"}),
    kProvenanceParam,
    part_param("csv,json,ply,rms,instance-error"),
    kPathRangeParam,
    merge_param("part,rms,instance-error,time-limit,checkpoint,resume"),
    kCheckpointParam,
    kResumeParam,
};

/// Whether paths are added until an error is small enough, and are not a fixed number.
bool has_error_limit(const Arguments& args) { return args.given("rms") || args.given("instance-error"); }

/// Returns the kind that --by names.
OrganKind organ_kind(const Arguments& args) {
  return OrganKind(std::ranges::find(kOrganKinds, args.text("by")) - std::begin(kOrganKinds));
}

/// Returns the name of the rows of --by in messages.
std::string_view organs_name(const JobRun& run) { return kOrganPlurals[size_t(organ_kind(run.args))]; }

/// Returns the largest of the errors relative to their limits, --rms and --instance-error: at most 1 when both are
/// met. Throws InputError if the instances have absorbed nothing: their error would never be met.
double largest_relative_error(const JobRun& run, const FluxMeasurement& measurement,
                              const std::optional<PhotonWeights>& photons) {
  double largest = 0;
  if (run.args.given("rms")) largest = measurement.error() / run.args.real("rms");
  if (!run.args.given("instance-error")) return largest;
  const InstanceErrors errors = instance_errors(measurement, photons);
  if (errors.known == 0)
    fail(scene_file(run.args),
         "{}: the {} absorb no light, of {} paths: there is no error to reach; give a smaller {} around them",
         run.args.spelled("instance-error"), organs_name(run), measurement.paths, run.args.spelled("target"));
  return std::max(largest, errors.median / run.args.real("instance-error"));
}

/// Returns the number of paths, which is even; of a refinement the first one.
uint64_t path_count(const JobRun& run, const FluxMeter& meter) {
  constexpr uint64_t kFirst = 1 << 16;
  // As in the BRF, each band needs some paths for its standard error.
  constexpr uint64_t kLeast = 32;
  const uint64_t paths = std::max(kLeast * meter.scene().wavelengths().bands().size(),
                                  has_error_limit(run.args) ? kFirst : uint64_t(run.args.count("paths")));
  return paths + paths % 2;
}

/// Returns nullopt if the measurement was stopped.
std::optional<FluxMeasurement> measure(const JobRun& run, const RenderControl& control, FluxMeter& meter,
                                       const std::optional<PhotonWeights>& photons, FluxParts& parts) {
  const uint64_t first = path_count(run, meter);
  if (parts.merges()) {
    parts.merge(meter, first);
    return meter.read();
  }
  const RefineLimits limits{first, uint64_t{1} << 40, has_error_limit(run.args) ? 1.0 : 0.0};
  parts.begin(meter, {0, first});
  const auto checkpoint = parts.checkpoint(meter);
  std::optional<FluxMeasurement> measurement;
  const RefineEnd end = refine(
      limits, meter.paths(), control,
      [&](uint64_t paths) {
        measurement.reset();
        if (meter.paths() < paths) meter.trace(paths - meter.paths(), run.session().pool(), control, checkpoint);
      },
      [&] { return largest_relative_error(run, measurement.emplace(meter.read()), photons); });
  if (end != RefineEnd::stopped && meter.paths() == 0)
    fail(scene_file(run.args), "{}: the time limit ended before any light path was traced",
         run.args.spelled("time-limit"));
  parts.end(meter);
  if (parts.finish(end != RefineEnd::stopped).stopped) return {};
  return measurement ? std::move(measurement) : meter.read();
}

/// Returns which option gives more paths: "raise --paths", or "lower --rms".
std::string more_paths_advice(const Arguments& args) {
  if (!has_error_limit(args)) return "raise " + args.spelled("paths");
  return "lower " + args.spelled(args.given("instance-error") ? "instance-error" : "rms");
}

/// Warns of materials that no path met.
void warn_of_unmet(const JobRun& run, const FluxMeasurement& measurement) {
  std::vector<std::string> unmet;
  for (const FluxMeasurement::OfMaterial& m : measurement.materials)
    if (!m.is_hit) unmet.push_back('"' + m.name + '"');
  if (!unmet.empty())
    run.log().warn({},
                   fmt::format("no path met the material{} {}: {} shares are unknown; {}, or give a smaller {}",
                               unmet.size() > 1 ? "s" : "", fmt::join(unmet, ", "), unmet.size() > 1 ? "their" : "its",
                               more_paths_advice(run.args), run.args.spelled("target")));
}

/// Warns of organs without an error: in no band a path was absorbed.
void warn_of_unmet_organs(const JobRun& run, const FluxMeasurement& measurement) {
  const size_t bands = measurement.bands.size(), count = measurement.areas.size();
  size_t unmet = 0;
  for (size_t i = 0; i < count; ++i)
    unmet += measurement.areas[i] > 0 &&
             std::ranges::all_of(std::span(measurement.by_organ).subspan(i * bands, bands),
                                 [](const MeanError& share) { return std::isnan(share.standard_error); });
  if (unmet > 0)
    run.log().warn({}, fmt::format("{} of {} {} met no light path, or absorb none: their errors are unknown; {}", unmet,
                                   count, organs_name(run), more_paths_advice(run.args)));
}

/// Relative error as text.
std::string percent(double share) {
  constexpr double kLarge = 10;  // nothing is known of what has such an error
  return share > kLarge ? fmt::format("more than {:g} %", 100 * kLarge)
                        : fmt::format("{:.{}f} %", 100 * share, share < 0.1 ? 1 : 0);
}

/// Reports the errors of single instances, which are far larger than the errors of their sums: in a warning if they are
/// too large, or larger than --instance-error, else as information.
void report_instance_errors(const JobRun& run, const FluxMeasurement& measurement, const InstanceErrors& errors) {
  constexpr double kTooLarge = 0.1, kProposed = 0.05;
  if (errors.known == 0) return;
  const std::string option = run.args.spelled("instance-error");
  const std::string text = fmt::format("relative standard error of the {} that single {} absorb: median {}, largest {}",
                                       errors.light, organs_name(run), percent(errors.median), percent(errors.largest));
  const double asked = run.args.given("instance-error") ? run.args.real("instance-error") : kTooLarge;
  if (errors.median <= asked) return run.log().info(text);
  if (run.args.given("instance-error"))
    return run.log().warn({}, fmt::format("{} {:g} was not reached; {}", option, asked, text));
  const double paths = double(measurement.paths) * std::pow(errors.median / kProposed, 2);
  run.log().warn(
      {}, fmt::format("{}; {} {:g} continues until the median is {:g} %{}", text, option, kProposed, 100 * kProposed,
                      errors.median < 1 ? fmt::format(", which takes about {:.2g} paths", paths) : ""));
}

/// Warns if the time limit ended the measurement before --rms or --paths was reached. Whether --instance-error was
/// reached is part of the report on instances.
void warn_of_end(const JobRun& run, const FluxMeasurement& measurement) {
  if (!run.args.given("instance-error") || run.args.given("rms"))
    warn_of_time_limit(run, measurement.paths, measurement.error());
}

/// Adds the table of organs before the others. In text for a terminal it follows them, unless a file has it. With
/// --quiet the text is the organs alone, as CSV: requested data.
void add_organs(const JobRun& run, Table organs, Result& result) {
  const Table& first = *result.tables.insert(result.tables.begin(), std::move(organs));
  if (run.args.given("csv") || run.args.given("json") || run.args.given("ply")) return;
  result.text = run.args.flag("quiet") ? to_csv(first, {}) : result.text + '\n' + to_text(first);
  result.is_requested = true;
}

/// Throws InputError for a target of a scene that is lit by lamps alone.
void check_target_has_light(const JobRun& run, const FluxMeter& meter) {
  for (const char* name : {"target", "sides"})
    if (run.args.given(name) && std::ranges::none_of(meter.scene().lights(), &Light::is_distant))
      fail(scene_file(run.args),
           "{}: light from outside enters there, and the scene has lamps in it alone, which need no target",
           run.args.spelled(name));
}

/// Returns the request, of which set_bands completes the bands of --bands. Throws InputError for --ply without --by.
FluxRequest request_of(const JobRun& run, const SpectrumPtr& irradiance) {
  const bool by_energy = run.args.given("bands");
  if (run.args.given("ply") && !run.args.given("by"))
    fail({}, "{} needs {}, whose rows the faces belong to", run.args.spelled("ply"), run.args.spelled("by"));
  FluxRequest request{.target = target_of(run.args),
                      .period = period_of(run.args),
                      .wavelengths = by_energy ? std::string() : wavelengths_text(run.args),
                      .irradiance = irradiance,
                      .irradiance_name = run.args.text("irradiance"),
                      .sides = run.args.flag("sides"),
                      .energy = by_energy,
                      .leaves = run.args.texts("material")};
  if (run.args.given("by")) request.organs = organ_kind(run.args);
  return request;
}

/// Warns if organs miss light that does not pass the target, unless the user has chosen it.
void warn_of_sides(const JobRun& run, const FluxRequest& request, const Scene& scene) {
  if (request.energy && request.organs && !request.target && !request.sides && !scene.period())
    run.log().warn({}, fmt::format("light that enters beside the scene's top does not count; {} counts it, for plants "
                                   "that stand alone, {} states the rectangle through which light enters",
                                   run.args.spelled("sides"), run.args.spelled("target")));
}

/// What a measurement needs beside its meter.
struct Prepared {
  FluxRequest request;
  std::optional<PhotonWeights> photons = {};
  std::string light = {};  ///< name of the light of photons
  std::vector<Fact> provenance = {};
};

/// Loads a scene. `last`: a meter of a scene that differs in lights alone, or nullptr; afterwards that of this scene.
Prepared prepare(const JobRun& run, const std::function<SceneDescription()>& describe, const RenderControl& control,
                 std::unique_ptr<FluxMeter>& last) {
  const SpectrumPtr irradiance = named_irradiance(run);
  Prepared prepared{request_of(run, irradiance)};
  auto& [request, photons, light, provenance] = prepared;
  const auto load = [&] {
    const SceneDescription description = describe();
    if (request.energy) {
      set_bands(run, description, request);
      warn_of_no_unit(run, description);
    }
    auto made = std::make_unique<FluxMeter>(run.session(), description, request, last ? &last->scene() : nullptr);
    if (!run.args.given("times")) check_target_has_light(run, *made);
    provenance = scene_provenance(made->scene(), description);
    photons = photon_weights(run, description, *made, irradiance);
    light = photon_light_name(run, description);
    return made;
  };
  last = within_time_limit(run, control, load, [&run] { return scene_file(run.args); });
  return prepared;
}

/// Traces the paths of --samples for --part. `last`: as for prepare.
Result measure_part(const JobRun& run, const std::function<SceneDescription()>& describe, FluxParts& parts,
                    std::unique_ptr<FluxMeter>& last) {
  const RenderControl control = run.control_until(run.args.real("time-limit"));
  (void)prepare(run, describe, control, last);
  run.context.log().check();
  const SampleRange paths = path_range_of(run.args, FluxMeter::kBlockPaths, path_count(run, *last));
  parts.begin(*last, paths);
  if (last->end() < paths.end)
    last->trace(paths.end - last->end(), run.session().pool(), control, parts.checkpoint(*last));
  parts.end(*last);
  return {.stopped = control.is_over()};
}

/// Traces light paths until the requested number or error is reached, with checkpoints. `last`: as for prepare.
Result measure_scene(const JobRun& run, const std::function<SceneDescription()>& describe, FluxParts& parts,
                     std::unique_ptr<FluxMeter>& last) {
  const bool has_organs = run.args.given("by");
  const RenderControl control = run.control_until(run.args.real("time-limit"));
  auto [request, photons, light, provenance] = prepare(run, describe, control, last);
  FluxMeter& meter = *last;
  const auto bands = meter.scene().wavelengths().bands();
  const bool lamps = has_lamps(meter.scene().lights());
  if (!photons && !lamps) explain_no_photons(run, bands);
  if (!lamps) warn_of_sides(run, request, meter.scene());
  run.context.log().check();
  auto measured = measure(run, control, meter, photons, parts);
  if (!measured) return {.stopped = true};
  const FluxMeasurement& measurement = *measured;
  const double error = measurement.error();
  warn_of_unmet(run, measurement);
  const bool are_weighted = !bands.front().response.empty();
  if (are_weighted && !run.args.given("irradiance")) light = kOfScene;
  // The tables without --bands are those of the first version, which scripts read (docs/compatibility.md): so is the
  // table of instances below.
  Result result = request.energy
                      ? energy_result(measurement, run.args.given("times"))
                      : Result{.tables = {share_table(measurement, photons)}, .text = share_text(measurement, photons)};
  result.facts.insert(
      result.facts.begin(),
      {{"paths", double(measurement.paths)}, {"error", error}, {"target_area", measurement.target_area}});
  // Under sun and sky --csv writes the files of the first version, without the surfaces; --json has them.
  size_t beside_csv = 0;
  Table surfaces = request.energy ? surface_energy_table(measurement) : surface_table(measurement, photons);
  if (!surfaces.columns.empty()) {
    if (measurement.has_lamps) result.text += '\n' + to_text(surfaces);
    beside_csv = measurement.has_lamps ? 0 : 1;
    result.tables.push_back(std::move(surfaces));
  }
  if (photons) result.facts.push_back({measurement.has_lamps ? "par_umol_s" : "par_umol_m2_s", photons->incident});
  if (photons || are_weighted) result.facts.push_back({"irradiance", light});
  result.facts.insert(result.facts.end(), provenance.begin(), provenance.end());
  run.log().info(
      fmt::format("{} paths; RMS standard error {:.2g}{}", measurement.paths, error,
                  photons && measurement.has_lamps ? fmt::format("; PAR of the lamps {:.5g} µmol/s", photons->incident)
                  : photons ? fmt::format("; incident PAR {:.5g} µmol/(m2 s), irradiance {}", photons->incident, light)
                  : are_weighted ? fmt::format("; bands are weighted by the irradiance {}", light)
                                 : ""));
  if (request.energy) explain_no_leaves(run, *measurement.energy);
  warn_of_end(run, measurement);
  if (has_organs) {
    warn_of_unmet_organs(run, measurement);
    if (request.energy) measured->energy->sunlit_organs = meter.sunlit_organs(run.session().pool());
    const InstanceErrors errors = instance_errors(measurement, photons);
    report_instance_errors(run, measurement, errors);
    result.facts.push_back({"instance_error_median", errors.median});
    result.facts.push_back({"instance_error_largest", errors.largest});
    const bool by_instance = request.organs == OrganKind::instance && !request.energy;
    add_organs(run, by_instance ? instance_table(measurement, photons) : organ_table(measurement, *meter.organs()),
               result);
    write_ply(run, measurement, *meter.organs());
  }
  result.csv_tables = result.tables.size() - beside_csv;
  return result;
}

/// The job: measures the scene, or with --times under the light of each time.
Result flux(const JobRun& run) {
  if (run.args.flag("fluorescence")) return fluorescence_flux_result(run);
  if (!run.args.given("by")) warn_if_nothing_is_kept(run);
  const std::list<PlannedOutput> planned = planned_tables(run.args);
  if (run.args.given("times") && !run.args.given("part"))
    for (const char* name : {"checkpoint", "resume"})
      if (run.args.given(name)) fail({}, "{} excludes {}", run.args.spelled("times"), run.args.spelled(name));
  FluxParts parts(run);
  // Shares its geometry with the scene of the next time.
  std::unique_ptr<FluxMeter> last;
  const auto measure_one = [&](const std::function<SceneDescription()>& describe) {
    return (parts.writes_part() ? measure_part : measure_scene)(run, describe, parts, last);
  };
  Result result;
  if (run.args.given("times")) {
    const SceneDescription description = described_scene(run);
    result = measure_times(run, read_time_series(run, description), description,
                           [&](const SceneDescription& at_time) { return measure_one([&] { return at_time; }); });
  } else {
    result = measure_one([&run] { return described_scene(run); });
  }
  return parts.writes_part() ? parts.finish(!run.control.stop.stop_requested()) : result;
}

}  // namespace

extern const JobInfo kFluxJob("flux", "Measure",
                              "Measure the light budget of a scene: reflection, transmission, absorption.",
                              "Reports shares of the incident light by wavelength: reflected, transmitted, and "
                              "absorbed by each material; with --bands also W/m2 and umol/(m2 s). With wavelengths "
                              "from 400 to 700 nm, also shares "
                              "of the photons (PAR). The share of a band with a response is that of the light under "
                              "it: the mean weighted by response times irradiance.",
                              kFluxParams, SessionUse::all, flux);

}  // namespace frond
