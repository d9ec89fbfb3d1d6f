#include "radiometry/structure.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "jobs/support/provenance.h"
#include "jobs/support/radiometry.h"
#include "jobs/support/refine.h"
#include "jobs/support/time_limit.h"
#include "report/chart.h"
#include "report/structure_chart.h"
#include "system/atomic_file.h"
#include "system/file_uses.h"

namespace frond {

// `frond structure`: leaf area index, gap fraction, clumping, leaf angles and sunlit leaf area of a scene
// (docs/radiometry.md).

namespace {

using enum ArgumentKind;

/// Largest zenith angle: rays closer to the horizon cross thousands of periods.
constexpr double kLargestZenith = 89.9;

constexpr JobParam kStructureParams[] = {
    kSceneParam,
    JobParam("zenith", numbers,
             "Zenith angles of the gap fraction, G, the clumping index, and the leaf area sunlit from there.",
             {.default_value = "0:80:10",
              .unit = "degrees",
              .range = {0, kLargestZenith},
              .decides = true,
              .quantity = PhysicalQuantity::angle}),
    JobParam("azimuth", numbers,
             "Azimuths of these, from +x toward +y; by default the mean over all azimuths is measured.",
             {.unit = "degrees", .decides = true}),
    JobParam("material", texts,
             "Material whose surfaces count as leaves, by its name in the scene; by default all leaf models.",
             {.type = "NAME", .decides = true}),
    JobParam("sun", numbers,
             "Zenith angle and azimuth, from +x toward +y, of the sun; by default those of the scene's only sun.",
             {.type = "ZENITH,AZIMUTH", .unit = "degrees", .values = 2, .decides = true}),
    kTargetParam,
    kPeriodParam,
    JobParam("rays", count, "Number of rays for each direction, and of points of leaves.",
             {.default_value = "1e5", .range = kCounts}),
    rms_param("Absolute standard error: stop when the RMS over the gap and sunlit fractions is below this; "
              "--rays is then not used."),
    kTimeLimitParam,
    kSeedParam,
    kIgnoreUnsupportedParam,
    kStrictParam,
    kCsvParam,
    kJsonParam,
    kProvenanceParam,
    chart_param("plot", "Chart against the zenith angle: .svg or .png."),
};

/// Names of the tables, of which --csv writes the first one and the others beside it.
constexpr const char* kDirections = "directions";
constexpr const char* kCanopy = "canopy";
constexpr const char* kAngles = "angles";

/// Returns --sun in degrees; nullopt: the scene's sun. Throws InputError for a sun below the horizon.
std::optional<std::array<double, 2>> sun_of(const Arguments& args) {
  const auto v = args.numbers("sun");
  if (v.empty()) return {};
  if (!(v[0] >= 0 && v[0] <= kLargestZenith))
    fail({}, "{}: the zenith angle {:g} is not between 0 and {:g}", args.spelled("sun"), v[0], kLargestZenith);
  return std::array{v[0], v[1]};
}

/// Returns nullopt if the measurement was stopped.
std::optional<StructureMeasurement> measure(const JobRun& run, const RenderControl& control, StructureMeter& meter) {
  // A refinement starts with few rays.
  constexpr uint64_t kFirst = 1 << 14;
  const bool refines = run.args.given("rms");
  const RefineLimits limits{refines ? kFirst : uint64_t(run.args.count("rays")), uint64_t{1} << 40,
                            run.args.real("rms")};
  // There is no partial result of an earlier run: a measurement takes seconds.
  const RefineEnd end = refine(
      limits, 0, control, [&](uint64_t rays) { meter.trace(rays - meter.rays(), run.session().pool(), control); },
      [&] { return meter.read().error(); });
  if (end == RefineEnd::stopped) return {};
  if (meter.rays() == 0)
    fail(scene_file(run.args), "{}: the time limit ended before the first round of rays",
         run.args.spelled("time-limit"));
  return meter.read();
}

/// One row for each direction. A mean over all azimuths has the azimuth "mean"; unknown values are empty.
Table direction_table(const StructureMeasurement& m) {
  Table table{kDirections};
  for (const StructureMeasurement::Direction& d : m.directions) {
    table.add("zenith_deg", d.zenith_deg);
    table.add("azimuth_deg", d.azimuth_deg);
    table.add("gap_fraction", d.gap);
    table.add("g", d.projection);
    table.add("clumping", d.clumping);
    table.add("sunlit_fraction", d.sunlit);
  }
  table.columns[1].missing = "mean";
  return table;
}

/// One row for each quantity of the canopy as a whole, so that the columns do not depend on what is known.
Table canopy_table(const StructureMeasurement& m) {
  Table table{kCanopy};
  const auto add = [&table](const char* quantity, const MeanError& value) {
    table.add("quantity", std::string(quantity));
    table.add("value", value);
  };
  add("leaf_area_index", m.leaf_area_index);
  add("effective_leaf_area_index", m.effective_index);
  add("mean_leaf_angle_deg", m.mean_angle_deg);
  add("sunlit_fraction", m.sunlit);
  return table;
}

/// Classes by their middles, as `frond canopy --angles` reads them.
Table angle_table(const StructureMeasurement& m) {
  Table table{kAngles};
  const double width = 90.0 / StructureMeasurement::kClasses;
  for (size_t i = 0; i < m.angles.size(); ++i) {
    table.add("angle_deg", (double(i) + 0.5) * width);
    table.add("frequency", m.angles[i]);
  }
  return table;
}

/// Plans the file of a table beside that of --csv, so that it is refused before the measurement if it cannot be
/// written or would replace an input.
void plan(const Arguments& args, const char* table, std::optional<PlannedOutput>& file) {
  const std::string csv = args.text("csv");
  if (csv.empty() || csv == "-") return;
  const std::string path = csv_beside(csv, table);
  file.emplace("the table of " + std::string(table) + " beside " + args.spelled("csv"), path);
  check_replaceable(path);
}

/// The job: traces rays until the requested number or error is reached.
Result structure(const JobRun& run) {
  check_chart_param(run, "plot");
  warn_if_nothing_is_kept(run);
  std::optional<PlannedOutput> canopy_file, angle_file;
  plan(run.args, kCanopy, canopy_file);
  plan(run.args, kAngles, angle_file);
  const StructureRequest request{.zeniths_deg = run.args.numbers("zenith"),
                                 .azimuths_deg = run.args.numbers("azimuth"),
                                 .materials = run.args.texts("material"),
                                 .sun_deg = sun_of(run.args),
                                 .target = target_of(run.args),
                                 .period = period_of(run.args)};
  const RenderControl control = run.control_until(run.args.real("time-limit"));
  const auto load = [&] { return std::make_unique<StructureMeter>(run.session(), described_scene(run), request); };
  const auto meter = within_time_limit(run, control, load, [&run] { return scene_file(run.args); });
  run.context.log().check();
  const auto measured = measure(run, control, *meter);
  if (!measured) return {.stopped = true};
  const StructureMeasurement& m = *measured;
  if (run.args.given("plot")) write_chart(run.args.text("plot"), structure_chart(m));
  run.log().info(fmt::format(
      "{} rays for each direction and points of leaves; RMS standard error {:.2g}{}", m.rays, m.error(),
      m.sun_deg ? fmt::format("; sun at zenith angle {:.4g}, azimuth {:.4g} degrees", (*m.sun_deg)[0], (*m.sun_deg)[1])
                : "; no sunlit fraction: the scene has no sun, or several; " + run.args.spelled("sun") + " gives one"));
  if (const double rms = run.args.real("rms"); rms > 0 && m.error() > rms)
    run.log().warn({}, fmt::format("{} {:g} was not reached", run.args.spelled("rms"), rms));
  else if (rms == 0 && m.rays < uint64_t(run.args.count("rays")))
    run.log().warn({},
                   fmt::format("the time limit ended: {} rays were traced, not {}", m.rays, run.args.count("rays")));
  Result result{.tables = {direction_table(m), canopy_table(m), angle_table(m)},
                .csv_tables = 3,
                .facts = {{"rays", double(m.rays)}, {"error", m.error()}, {"target_area", m.target_area}}};
  for (Fact& fact : scene_provenance(meter->scene().scene(), meter->scene().description()))
    result.facts.push_back(std::move(fact));
  if (m.sun_deg) {
    result.facts.push_back({"sun_zenith_deg", (*m.sun_deg)[0]});
    result.facts.push_back({"sun_azimuth_deg", (*m.sun_deg)[1]});
  }
  // The summary first; CSV has it second, because the directions are the larger table.
  result.text = to_text(result.tables[1]) + '\n' + to_text(result.tables[0]);
  return result;
}

}  // namespace

extern const JobInfo kStructureJob(
    "structure", "Measure", "Measure the structure of a canopy: leaf area, gap fraction, clumping, sunlit leaves.",
    "Rays through the target measure the gap fraction: the share of them that meet no leaf; other surfaces do not stop "
    "them. Points of the leaves measure the leaf area index, the leaf angles, their mean projection G, and the share "
    "of the leaf area that the sun reaches. The clumping index is -ln(gap fraction) cos(zenith) / (G LAI).",
    kStructureParams, SessionUse::threads, structure);

}  // namespace frond
