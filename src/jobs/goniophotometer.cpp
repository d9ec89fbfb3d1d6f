#include "instruments/goniophotometer.h"

#include <algorithm>

#include "jobs/support/fluorescence_tables.h"
#include "jobs/support/instrument.h"
#include "report/chart.h"
#include "report/patch_charts.h"

namespace frond {

// `frond goniophotometer`: BRDF and BTDF of a material over the whole sphere, by rays or by integration
// (docs/instruments.md).

namespace {

using enum ArgumentKind;

constexpr std::string_view kScales[] = {"linear", "log"};

constexpr JobParam kGoniophotometerParams[] = {
    kMaterialParam,
    kOptionalWavelengthsParam,
    kAnglesParam,
    kWithParam,
    kIlluminantParam,
    JobParam("rays", count,
             "Number of rays for each measurement; with --fluorescence for each pair of wavelengths, divided evenly "
             "among the patches.",
             {.default_value = "1e6", .range = kRayCounts, .decides = true}),
    JobParam("patches", text, "THETAxPHI: numbers of detector patches, equal in angle, over the whole sphere.",
             {.type = "THETAxPHI", .default_value = "20x40", .decides = true}),
    JobParam("integrate", flag,
             "Integrate f over each patch, without noise, if the material evaluates f exactly and the light is of one "
             "wavelength; otherwise use rays.",
             {.decides = true}),
    kRenderedParam,
    JobParam("fluorescence", flag,
             "Measure the fluorescence of both sides: photon radiance per nm of emission over photon irradiance.",
             {.decides = true, .excludes = "wavelengths,integrate,rendered,illuminant"}),
    excitation_param("440"),
    emission_param("685,740"),
    kSeedParam,
    kCsvParam,
    kJsonParam,
    kProvenanceParam,
    chart_param("plot", "Chart of f in the plane of incidence: .svg or .png."),
    chart_param("map", "Polar maps of f over both hemispheres: .svg or .png."),
    JobParam("map-scale", text, "Colour scale of the map.", {.default_value = "linear", .choices = kScales}),
};

/// Parses --patches. "20,40" is accepted as well as "20x40", because Python passes two numbers with a comma.
DetectorSphere sphere_of(const Arguments& args) {
  std::string words = args.text("patches");
  std::ranges::replace(words, 'x', ',');
  const auto counts = parse_numbers(words).value_or(std::vector<double>());
  const auto is_count = [](double n) { return n == std::floor(n) && std::abs(n) <= DetectorSphere::kMostPatches; };
  if (counts.size() != 2 || !std::ranges::all_of(counts, is_count))
    fail({}, "{}: two whole numbers are needed, as in 20x40; \"{}\" was given", args.spelled("patches"),
         args.text("patches"));
  return {int(counts[0]), int(counts[1])};
}

std::string kind_of(const GoniophotometerMeasurement& r, const Patch& p) {
  if (!r.fluorescence.empty()) return r.is_reflected(p) ? "lit side" : "other side";
  return r.is_reflected(p) ? "BRDF" : "BTDF";
}

/// Table with one row for each patch of each measurement.
Table table_of(const std::vector<LabelledPatches>& measurements) {
  Table table{"measurements"};
  for (const auto& [material, r] : measurements)
    for (size_t i = 0; i < r.sphere.size(); ++i) {
      const Patch p = r.sphere.patch(i);
      table.add("incidence_deg", r.beam.theta_deg);
      add_light(table, r.beam);
      table.add("theta_min_deg", p.theta_min_deg);
      table.add("theta_max_deg", p.theta_max_deg);
      table.add("theta_deg", p.theta_deg());
      table.add("phi_min_deg", p.phi_min_deg);
      table.add("phi_max_deg", p.phi_max_deg);
      table.add("phi_deg", p.phi_deg());
      table.add("solid_angle_sr", p.solid_angle);
      table.add("projected_solid_angle_sr", p.projected_solid_angle);
      table.add("kind", kind_of(r, p));
      table.add(r.fluorescence.empty() ? "f_per_sr" : "f_per_sr_nm", r.f(i).mean);
      table.add("f_se", r.f(i).standard_error());
      if (r.fluorescence.empty()) table.add("caught", double(r.count(i)));
      table.add("rays", double(r.rays));
      table.add("material", material);
    }
  table.document("incidence_deg",
                 "from the front's normal to the light, degrees; above 90 the back (abaxial side) is lit");
  table.document("theta_deg", "of the detector, from the front's normal; patches are equal in theta and in phi");
  table.document("phi_deg",
                 "from the light's azimuth; the first patch is centred on 0, the mirror direction is at 180");
  if (table.find("caught")) {
    table.document("f_per_sr", "BRDF (on the lit side) or BTDF, 1/sr: weight sum / (rays * projected solid angle)");
    table.document("caught", "number of rays that reached the patch");
  } else {
    table.document("f_per_sr_nm", "photon radiance per nm of emission over photon irradiance, 1/(sr nm)");
  }
  table.document("f_se", "standard error of f");
  table.document("rays", "number of rays of light; 0 where f was integrated over the patches, without noise");
  return table;
}

/// Summary with one row for each side of each measurement: share of the light, and position of the largest f.
Table summary_of(const std::vector<LabelledPatches>& measurements) {
  Table table{"summary"};
  for (const auto& [material, r] : measurements)
    for (const bool reflected : {true, false}) {
      size_t largest = r.sphere.size();
      for (size_t i = 0; i < r.sphere.size(); ++i)
        if (r.is_reflected(r.sphere.patch(i)) == reflected &&
            (largest == r.sphere.size() || r.f(i).mean > r.f(largest).mean))
          largest = i;
      const Patch p = r.sphere.patch(largest);
      const Estimate share = r.share(reflected), f = r.f(largest);
      table.add("material", material);
      table.add("incidence_deg", r.beam.theta_deg);
      add_light(table, r.beam);
      table.add("measured_by", r.is_integrated() ? std::string("integration") : fmt::format("{} rays", r.rays));
      table.add("kind", kind_of(r, p));
      table.add("share", share.mean, share.standard_error());
      table.add("largest_per_sr", f.mean, f.standard_error());
      table.add("at_theta_deg", p.theta_deg());
      table.add("at_phi_deg", p.phi_deg());
    }
  return table;
}

/// Throws InputError for charts that cannot be drawn.
void check_charts(const JobRun& run, const MeasurementCounts& counts, const DetectorSphere& sphere) {
  if (run.args.given("plot")) check_plane_chart(counts, sphere);
  if (run.args.given("map")) check_map_chart(counts, sphere);
}

/// Throws InputError for requests that would fail after the measurements.
void check(const JobRun& run, const MaterialsUnderTest& tested, const DetectorSphere& sphere) {
  check_charts(run, {tested.materials().size(), tested.angles_deg().size(), tested.lights().size()}, sphere);
  for (size_t i = 0; i < tested.size(); ++i) check_no_delta_lobe(tested.lit_material(i));
}

/// Integration is possible only if the material evaluates f exactly.
GoniophotometerMeasurement measure(const JobRun& run, const MaterialsUnderTest& tested, size_t i,
                                   const DetectorSphere& sphere) {
  run.check_stop();
  const LitMaterial lit = tested.lit_material(i);
  if (run.args.flag("integrate") && has_exact_f(lit) && !lit.beam.band)
    return integrate_f(lit, sphere, run.session().pool());
  const int64_t rays = run.args.count("rays");
  return measure_f(lit, sphere, rays, run.session().pool(), tested.progress(i, rays));
}

/// Writes the charts; returns the tables and the text.
Result result_of(const JobRun& run, const DetectorSphere& sphere, const std::vector<LabelledPatches>& measurements,
                 std::vector<std::string> notes, const std::string& last_lines) {
  if (run.control.progress) run.control.progress->finish();
  if (run.args.given("plot")) write_chart(run.args.text("plot"), plane_chart(measurements));
  if (run.args.given("map"))
    write_chart(run.args.text("map"), map_chart(measurements, run.args.text("map-scale") == "log"));
  const Table summary = summary_of(measurements);
  return {.tables = {table_of(measurements), summary},
          .notes = std::move(notes),
          .text = fmt::format("{} x {} patches; where f is largest\n{}{}", sphere.thetas(), sphere.phis(),
                              to_text(summary), last_lines)};
}

/// The job with --fluorescence.
Result measured_fluorescence(const JobRun& run, const DetectorSphere& sphere) {
  const std::vector<double> excitation_nm = ascending_wavelengths(run.args, "excitation"),
                            emission_nm = ascending_wavelengths(run.args, "emission");
  std::vector<Beam> beams;
  for (const double theta_deg : run.args.numbers("angles"))
    for (const double excitation : excitation_nm)
      for (const double emission : emission_nm) beams.push_back({theta_deg, excitation, nullptr, emission});
  check_charts(run,
               {materials_of(run).size(), run.args.numbers("angles").size(), excitation_nm.size() * emission_nm.size()},
               sphere);
  const std::vector<FluorescentSpecimen> specimens = fluorescent_specimens(run);
  std::vector<LabelledPatches> measurements;
  for (const FluorescentSpecimen& s : specimens)
    for (const Beam& beam : beams) {
      run.check_stop();
      if (run.control.progress)
        run.control.progress->update(double(measurements.size()) / double(specimens.size() * beams.size()), {});
      measurements.push_back({s.label, measure_fluorescence_f(*s.fluorescence, beam, sphere, run.args.count("rays"),
                                                              s.seed, run.session().pool())});
    }
  return result_of(run, sphere, measurements, fluorescence_notes(run, "goniophotometer", specimens),
                   emission_text(specimens));
}

/// The job. Charts are checked before the first ray.
Result goniophotometer(const JobRun& run) {
  check_chart_param(run, "plot");
  warn_if_nothing_is_kept(run);
  check_chart_param(run, "map");
  const DetectorSphere sphere = sphere_of(run.args);
  if (run.args.flag("fluorescence")) return measured_fluorescence(run, sphere);
  check_wavelengths_are_given(run);
  const MaterialsUnderTest tested(run);
  check(run, tested, sphere);
  std::vector<LabelledPatches> measurements;
  for (size_t i = 0; i < tested.size(); ++i)
    measurements.push_back({tested.material(i).label(), measure(run, tested, i, sphere)});
  return result_of(run, sphere, measurements, tested.notes("goniophotometer"), tested.illuminant_text());
}

}  // namespace

extern const JobInfo kGoniophotometerJob("goniophotometer", "Measure",
                                         "Measure a material's BRDF and BTDF over the whole sphere.", "",
                                         kGoniophotometerParams, SessionUse::all, goniophotometer);

}  // namespace frond
