#include <algorithm>

#include "instruments/conformance/material_conformance.h"
#include "instruments/given_wavelengths.h"
#include "jobs/record/common_params.h"
#include "render/material_words.h"
#include "render/refusing_log.h"
#include "report/chart.h"
#include "report/conform_report.h"
#include "scene/resolver.h"

namespace frond {

// `frond conform`: statistical and exact tests of the laws that every BSDF must have (docs/validation.md).

namespace {

using enum ArgumentKind;

constexpr double kFewestSamples = 1000;   // with fewer samples, tests have almost no power
constexpr double kMostSamples = 1 << 26;  // which are kept: 5 GB
/// Largest angle, just below the horizon.
constexpr double kGrazing_deg = 89.9999;

constexpr JobParam kParams[] = {
    kMaterialParam,
    JobParam("sweep", flag, "Also test parameters that are not given, over their declared ranges.", {.decides = true}),
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
    kCsvParam,
    kJsonParam,
    chart_param("map", "Map of the directions of the worst finding: .svg or .png.", "picture"),
};

/// With --sweep, returns parameter sets over the declared ranges; otherwise the given set alone.
std::vector<ParameterSet> parameter_sets(const MaterialWords& material, const PluginText& text, const Arguments& args) {
  if (args.flag("sweep"))
    return parameter_sweep(material.info, {.pinned = material.plugin.params, .seed = args.seed("seed")});
  return {{text.params.empty() ? "defaults" : words_of(text), material.plugin}};
}

/// Whether the material may refuse values other than its declared defaults: parameters or wavelengths are given, or a
/// parameter is required.
bool is_asked_for(const MaterialWords& material, const Arguments& args) {
  return !material.plugin.params.empty() || args.given("wavelengths") ||
         std::ranges::any_of(material.info.params, &Param::required);
}

/// Splits wavelengths into groups of at most kLanes, the number that a path carries.
std::vector<GivenWavelengths> in_lanes(const std::vector<double>& nm) {
  std::vector<GivenWavelengths> groups;
  for (size_t i = 0; i < nm.size(); i += kLanes) {
    const auto group = std::span(nm).subspan(i, std::min<size_t>(kLanes, nm.size() - i));
    groups.emplace_back(std::vector<float>(group.begin(), group.end()));
  }
  return groups;
}

/// Tests the material in groups of wavelengths, and judges all findings together, so that the false alarm rate holds.
ConformReport examine_material(const JobRun& run) {
  const Arguments& args = run.args;
  const Registry& registry = run.session().registry();
  const std::string text = material_text(args.texts("material"));
  const MaterialWords material = parse_material(text, registry);
  const SceneDescription others = scene_of_materials(registry);
  const auto sets = parameter_sets(material, parse_plugin_text(text, {}), args);
  ConformReport report{.material = text,
                       .wavelengths_nm = args.numbers("wavelengths"),
                       .effort = {.samples = int(args.count("samples")),
                                  .angles_deg = args.numbers("angles"),
                                  .seed = args.seed("seed"),
                                  .maps = args.given("map")},
                       .false_alarm_rate = args.real("false-alarm-rate"),
                       .findings = {}};
  const Claims claims{args.flag("lossless"), args.flag("reciprocal")};
  const RefusingLog refusing;
  const std::filesystem::path no_cache;  // a sweep would fill the cache with tables of leaves that no scene has
  for (const GivenWavelengths& wavelengths : in_lanes(report.wavelengths_nm)) {
    run.check_stop();
    SceneResolver resolver(others, registry, wavelengths, refusing);
    const Preparation preparation{wavelengths, run.session().pool(), run.log(),
                                  args.flag("sweep") ? no_cache : run.context.options().cache};
    const Findings findings =
        examine(material.info, sets, {preparation, resolver, claims, report.effort, is_asked_for(material, args)});
    report.findings.insert(report.findings.end(), findings.begin(), findings.end());
  }
  report.level = judge(report.findings, report.false_alarm_rate);
  return report;
}

/// The job. The map is drawn before the report is returned, so that a failure to draw is an error.
Result conform(const JobRun& run) {
  constexpr int kBroken = 2;
  check_chart_param(run, "map");
  const ConformReport report = examine_material(run);
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
                                 "Exit code 0: all laws hold; 2: a law is broken.", kParams, SessionUse::all, conform);

}  // namespace frond
