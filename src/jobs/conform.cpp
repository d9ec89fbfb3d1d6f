#include <fmt/format.h>

#include <algorithm>

#include "instruments/conformance/material_conformance.h"
#include "instruments/given_wavelengths.h"
#include "jobs/record/common_params.h"
#include "render/measured_material.h"
#include "render/progress.h"
#include "report/chart.h"
#include "report/conform_report.h"
#include "scene/resolver.h"

namespace frond {

// `frond conform`: statistical and exact tests of the laws that every BSDF must have (docs/results/validation.md).

namespace {

using enum ArgumentKind;

constexpr double kFewestSamples = 1000;   // with fewer samples, tests have almost no power
constexpr double kMostSamples = 1 << 26;  // which are kept: 5 GB
/// Largest angle, just below the horizon.
constexpr double kGrazing_deg = 89.9999;

constexpr JobParam kConformParams[] = {
    kMaterialParam,
    JobParam("given-only", flag,
             "Test the given parameters and defaults only. By default parameters that are not given are also tested at "
             "the ends of their ranges and at all choices, one at a time, with a tenth of the samples.",
             {.decides = true, .excludes = "sweep"}),
    JobParam("sweep", flag,
             "Test the ranges of parameters that are not given finely: with all samples, also corners, points inside, "
             "and 1000 in place of an infinite end.",
             {.decides = true}),
    JobParam("samples", count, "Number of samples for each direction.",
             {.default_value = "20000", .range = {kFewestSamples, kMostSamples}, .decides = true}),
    JobParam("angles", numbers, "Angles of wo from the normal, on both sides.",
             {.default_value = "0,30,60,80,89",
              .unit = "degrees",
              .range = {0, kGrazing_deg},
              .aliases = "angle",
              .decides = true}),
    JobParam(
        "wavelengths", numbers, "Wavelengths, tested in groups of four.",
        {.default_value = "608,551,455", .unit = "nm", .range = kAboveZero, .aliases = "wavelength", .decides = true}),
    JobParam("seed", seed, "Seed of all random numbers.", {.default_value = "1", .decides = true}),
    JobParam("lossless", flag, "Claim that the material absorbs nothing with these parameters.", {.decides = true}),
    JobParam("reciprocal", flag, "Claim f(a, b) = f(b, a), in addition to the material's own claims.",
             {.decides = true}),
    JobParam("false-alarm-rate", real, "Probability of reporting a broken law although all laws hold.",
             {.default_value = "1e-6", .range = {1e-12, 0.5}, .decides = true}),
    JobParam(
        "excess", real,
        "Excess of exitant over incident power that the law of energy must find with a probability of 95 %: it draws "
        "further samples, up to 50 times --samples. 0: no further samples.",
        {.default_value = "0.05", .range = {0, 1}, .decides = true}),
    kCsvParam,
    kJsonParam,
    chart_param("map", "Map of the directions of the worst finding: .svg or .png.", "picture"),
};

/// Whether the material may reject values other than its declared defaults: parameters or wavelengths are given, or a
/// parameter is required.
bool has_given_values(const MaterialWords& material, const Arguments& args) {
  return !material.plugin.params.empty() || args.given("wavelengths") ||
         std::ranges::any_of(material.info.params, &Param::required);
}

/// Splits wavelengths into groups of at most kLanes, the number that a path carries.
std::vector<GivenWavelengths> split_into_lanes(const std::vector<double>& nm) {
  std::vector<GivenWavelengths> groups;
  for (size_t i = 0; i < nm.size(); i += kLanes) {
    const auto group = std::span(nm).subspan(i, std::min<size_t>(kLanes, nm.size() - i));
    groups.emplace_back(std::vector<float>(group.begin(), group.end()));
  }
  return groups;
}

/// With fewer samples than at the given parameters, each end of a range costs less; the law of energy draws as many as
/// it needs anyway.
int samples_at_ends(const Arguments& args) {
  constexpr double kShare = 0.1;
  const double all = double(args.count("samples"));
  return int(args.flag("sweep") ? all : std::max(kFewestSamples, kShare * all));
}

/// One conformance test of a material: its sets of parameters, in groups of wavelengths.
class MaterialTest {
 public:
  explicit MaterialTest(const JobRun& run)
      : run_(run),
        registry_(run.session().registry()),
        text_(material_text(run.args.texts("material"))),
        material_(parse_material(text_, registry_)),
        others_(scene_of_materials(registry_)) {
    const PluginText parsed = parse_plugin_text(text_, {});
    given_ = {parsed.params.empty() ? "defaults" : parameter_text(parsed), material_.plugin};
    if (run.args.flag("given-only")) return;
    SweepOptions sweep{.pinned = material_.plugin.params, .seed = run.args.seed("seed")};
    if (!run.args.flag("sweep")) sweep.random_corners = sweep.random_points = 0, sweep.infinite_ends = false;
    ends_ = parameter_sweep(material_.info, sweep);
    ends_.erase(ends_.begin());  // the given set
    swept_ = swept_params(material_.info, sweep);
  }

  /// Tests all sets, and judges all findings together, so that the false-alarm rate holds.
  ConformReport report() {
    const Arguments& args = run_.args;
    ConformReport report{.material = text_,
                         .wavelengths_nm = args.numbers("wavelengths"),
                         .effort = {.samples = int(args.count("samples")),
                                    .angles_deg = args.numbers("angles"),
                                    .seed = args.seed("seed"),
                                    .maps = args.given("map"),
                                    .excess = args.real("excess"),
                                    .false_alarm_rate = args.real("false-alarm-rate")},
                         .parameters = {.are_defaults = material_.plugin.params.empty(),
                                        .given_only = args.flag("given-only"),
                                        .are_swept = args.flag("sweep"),
                                        .sets = ends_.size() + 1,
                                        .samples_at_ends = samples_at_ends(args),
                                        .varied = swept_.varied,
                                        .unvaried = swept_.unvaried}};
    for (const GivenWavelengths& wavelengths : split_into_lanes(report.wavelengths_nm)) test(wavelengths, report);
    if (run_.control.progress) run_.control.progress->finish();
    report.level = apply_false_alarm_rate(report.findings, report.effort.false_alarm_rate);
    return report;
  }

 private:
  void test(const GivenWavelengths& wavelengths, ConformReport& report) {
    const RefusingLog refusing;
    SceneResolver resolver(others_, registry_, wavelengths, refusing);
    const Preparation cached{wavelengths, run_.session().pool(), run_.log(), run_.context.options().cache};
    // Ends of ranges would fill the cache with tables of leaves that no scene has.
    const Preparation uncached{wavelengths, run_.session().pool(), silent_log(), {}};
    const Claims claims{run_.args.flag("lossless"), run_.args.flag("reciprocal")};
    MaterialExamination how{cached, resolver, claims, report.effort, has_given_values(material_, run_.args)};
    add(examine(material_.info, {&given_, 1}, how), wavelengths, report);
    ExaminationEffort less = report.effort;
    less.samples = report.parameters.samples_at_ends;
    MaterialExamination of_ends{uncached, resolver, claims, less, false, true};
    of_ends.on_refusal = [&report](const ParameterSet& set, const InputError& e) {
      const std::string refusal = fmt::format("{}: {}", set.label, e.what());
      auto& refused = report.parameters.refused;
      if (std::ranges::find(refused, refusal) == refused.end()) refused.push_back(refusal);
    };
    for (const ParameterSet& set : ends_) add(examine(material_.info, {&set, 1}, of_ends), wavelengths, report);
  }

  void add(const Findings& findings, const GivenWavelengths& wavelengths, ConformReport& report) {
    report.findings.insert(report.findings.end(), findings.begin(), findings.end());
    run_.check_stop();
    const double all = double(report.parameters.sets) * double(report.wavelengths_nm.size());
    done_ += double(wavelengths.fixed_nm().size());
    if (run_.control.progress) run_.control.progress->update(std::min(1.0, done_ / all), {});
  }

  const JobRun& run_;
  const Registry& registry_;
  std::string text_;
  MaterialWords material_;
  SceneDescription others_;
  ParameterSet given_;
  std::vector<ParameterSet> ends_;
  SweptParams swept_;
  double done_ = 0;
};

/// The job. The map is drawn before the report is returned, so that a failure to draw is an error.
Result conform(const JobRun& run) {
  constexpr int kBroken = 2;
  check_chart_param(run, "map");
  const ConformReport report = MaterialTest(run).report();
  if (run.args.given("map")) {
    const std::string path = run.args.text("map");
    const Finding* finding = finding_to_draw(report);
    if (!finding) fail({}, "{}: no finding has directions to draw", path);
    write_chart(path, sphere_chart(*finding));
  }
  return {.tables = conform_tables(report),
          .facts = conform_facts(report),
          .text = conform_text(report),
          .code = report.all_hold() ? 0 : kBroken};
}

}  // namespace

extern const JobInfo kConformJob("conform", "Materials", "Test whether a material obeys the laws of scattering.",
                                 "Exit code 0: no law was found broken; 2: a law is broken.", kConformParams,
                                 SessionUse::all, conform);

}  // namespace frond
