#include "instruments/spectrophotometer.h"

#include <limits>

#include "jobs/support/fluorescence_tables.h"
#include "jobs/support/instrument.h"
#include "report/chart.h"
#include "report/share_tables.h"

namespace frond {

// `frond spectrophotometer`: reflectance, transmittance and absorptance of a material (docs/instruments.md).

namespace {

using enum ArgumentKind;

constexpr JobParam kSpectrophotometerParams[] = {
    kMaterialParam,
    kOptionalWavelengthsParam,
    kAnglesParam,
    kWithParam,
    kIlluminantParam,
    JobParam("rays", count,
             "Number of rays for each measurement, by default 1e6; with --se the maximum, by default 1e9; with "
             "--fluorescence for each pair of wavelengths, by default 1e4.",
             {.range = kRayCounts, .decides = true}),
    JobParam("se", real, "Stop when the standard errors of R, T and A are at most this.",
             {.range = kAboveZero, .aliases = "standard-error", .decides = true}),
    kRenderedParam,
    JobParam("fluorescence", flag,
             "Measure the excitation-emission matrices of both sides: photons per nm of emission per incident photon.",
             {.decides = true, .excludes = "wavelengths,se,rendered,illuminant"}),
    excitation_param("400:750:10"),
    emission_param("640:850:10"),
    kSeedParam,
    kCsvParam,
    kJsonParam,
    kProvenanceParam,
    chart_param("plot",
                "Chart of R and T against wavelength or angle, or maps of fluorescence over excitation and "
                "emission: .svg or .png."),
};

/// A share of the incident light, its column and its estimate.
struct Share {
  const char* name;
  Estimate SpectrophotometerMeasurement::*value;
  bool is_optional;  ///< requires a material whose flags distinguish surface from subsurface scattering
};
constexpr Share kShares[] = {{"Rs", &SpectrophotometerMeasurement::surface, true},
                             {"Rd", &SpectrophotometerMeasurement::subsurface, true},
                             {"R", &SpectrophotometerMeasurement::reflectance, false},
                             {"T", &SpectrophotometerMeasurement::transmittance, false},
                             {"A", &SpectrophotometerMeasurement::absorptance, false}};

/// Table with one row for each measurement.
Table table_of(std::span<const LabelledMeasurement> measurements) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Table table{"measurements"};
  for (const LabelledMeasurement& measurement : measurements) {
    const auto& [material, r] = measurement;
    table.add("theta_deg", r.beam.theta_deg);
    add_light(table, r.beam);
    const auto is_known = [&, distinguishes_surface = r.distinguishes_surface](const Share& s) {
      return !s.is_optional || distinguishes_surface;
    };
    for (const Share& s : kShares) table.add(s.name, is_known(s) ? (r.*s.value).mean : kNone);
    for (const Share& s : kShares)
      table.add(std::string(s.name) + "_se", is_known(s) ? (r.*s.value).standard_error() : kNone);
    table.add("rays", double(r.rays));
    table.add("material", material);
  }
  table.document("theta_deg", "from the front's normal to the light, degrees; above 90 the back (abaxial side) is lit");
  table.document("Rs",
                 "share of the light, 0 to 1, that the surface reflects at the first event; blank where the "
                 "material does not tell Rs and Rd apart");
  table.document("Rd", "share that leaves the tissue on the lit side");
  table.document("R", "Rs + Rd, the share that is reflected; columns ending in _se: standard errors");
  table.document("T", "share that leaves on the other side");
  table.document("A", "1 - R - T, the share that is absorbed");
  table.document("rays", "number of rays of light");
  table.columns.back().only_data = true;
  return table;
}

/// Returns a table for each material, headed by the material's name.
std::string text_of(const std::vector<LabelledMeasurement>& measurements, size_t per_material) {
  std::string text;
  for (size_t i = 0; i < measurements.size(); i += per_material)
    text += (i > 0 ? "\n" : "") + measurements[i].material + '\n' +
            to_text(table_of(std::span(measurements).subspan(i, per_material)));
  return text;
}

/// Warns if the largest number of rays was reached before the requested standard error.
void warn_of_unmet_error(const JobRun& run, const RayBudget& budget,
                         const std::vector<LabelledMeasurement>& measurements) {
  const auto missed = std::ranges::count_if(measurements, [&](const LabelledMeasurement& r) {
    return r.measurement.standard_error() > budget.standard_error;
  });
  if (budget.standard_error > 0 && missed > 0)
    run.log().warn({}, fmt::format("{} of {} measurements reached {} rays before a standard error of {}", missed,
                                   measurements.size(), budget.rays, budget.standard_error));
}

/// The job. The chart is checked before the first ray.
Result spectrophotometer(const JobRun& run) {
  check_chart_param(run, "plot");
  warn_if_nothing_is_kept(run);
  // Other tables and charts, of other wavelengths.
  if (run.args.flag("fluorescence")) return fluorescence_result(run);
  check_wavelengths_are_given(run);
  // With --se, measurements end by their error, so the default limit is larger.
  constexpr int64_t kRays = 1'000'000, kMostRays = 1'000'000'000;
  const int64_t by_default = run.args.given("se") ? kMostRays : kRays;
  const RayBudget budget{run.args.given("rays") ? run.args.count("rays") : by_default, run.args.real("se")};
  const MaterialsUnderTest tested(run);
  if (run.args.given("plot"))
    check_shares_chart(tested.materials().size(), tested.angles_deg().size(), tested.lights().size());
  std::vector<LabelledMeasurement> measurements;
  for (size_t i = 0; i < tested.size(); ++i)
    measurements.push_back(
        {tested.material(i).label(),
         measure_shares(tested.lit_material(i), budget, run.session().pool(), tested.progress(i, budget.rays))});
  if (run.control.progress) run.control.progress->finish();
  warn_of_unmet_error(run, budget, measurements);
  if (run.args.given("plot")) write_chart(run.args.text("plot"), shares_chart(measurements));
  return {.tables = {table_of(measurements)},
          .notes = tested.notes("spectrophotometer"),
          .text = text_of(measurements, tested.per_material()) + tested.illuminant_text()};
}

}  // namespace

extern const JobInfo kSpectrophotometerJob("spectrophotometer", "Measure",
                                           "Measure a material's reflectance, transmittance and absorptance.", "",
                                           kSpectrophotometerParams, SessionUse::all, spectrophotometer);

}  // namespace frond
