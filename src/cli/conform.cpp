#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/number_list.h"
#include "core/log.h"
#include "instruments/given_wavelengths.h"
#include "instruments/material_conformance.h"
#include "render/material_words.h"
#include "render/plugins.h"
#include "render/refusing_log.h"
#include "report/chart.h"
#include "report/conform_report.h"
#include "report/text_output.h"
#include "scene/resolver.h"

namespace frond {
namespace {

/// Exit code where a law is broken.
constexpr int kBroken = 2;

struct ConformOptions {
  std::vector<std::string> material, plugins;
  std::string angles = "0,30,60,80,89", wavelengths = "608,551,455", samples = "20000", json, picture;
  uint64_t seed = 1;
  double false_alarm_rate = 1e-6;
  Claims claims;
  bool sweep = false;
};

ExaminationEffort effort_of(const ConformOptions& o) {
  constexpr int64_t kFewest = 1000;  // below it, tests have next to no power
  ExaminationEffort effort{
      .samples = static_cast<int>(std::min<int64_t>(parse_count("--samples", o.samples, kFewest), 1 << 30)),
      .angles_deg = parse_numbers("--angles", o.angles),
      .seed = o.seed,
      .maps = !o.picture.empty()};
  for (const double angle : effort.angles_deg)
    if (!(angle >= 0 && angle < 90)) fail({}, "--angles: {} is not from 0 to below 90 degrees", angle);
  return effort;
}

std::vector<ParameterSet> parameter_sets(const MaterialWords& material, const ConformOptions& o) {
  if (o.sweep) return parameter_sweep(material.info, {.pinned = material.plugin.params, .seed = o.seed});
  return {{o.material.size() > 1 ? fmt::format("{}", fmt::join(std::span(o.material).subspan(1), " ")) : "defaults",
           material.plugin}};
}

/// Whether what the material may refuse is more than its own declared values: parameters, wavelengths, or a word that
/// it cannot do without.
bool is_asked_for(const MaterialWords& material, const ConformOptions& o) {
  return !material.plugin.params.empty() || o.wavelengths != ConformOptions{}.wavelengths ||
         std::ranges::any_of(material.info.params, &Param::required);
}

/// As many at once as a path carries.
std::vector<GivenWavelengths> in_lanes(const std::vector<double>& nm) {
  std::vector<GivenWavelengths> groups;
  for (size_t i = 0; i < nm.size(); i += kLanes) {
    const auto group = std::span(nm).subspan(i, std::min<size_t>(kLanes, nm.size() - i));
    for (const double wavelength : group)
      if (!(wavelength > 0)) fail({}, "--wavelengths: {} nm is no wavelength", wavelength);
    groups.emplace_back(std::vector<float>(group.begin(), group.end()));
  }
  return groups;
}

ConformReport examine_material(const ConformOptions& o) {
  const Registry registry = load_registry(o.plugins);
  const MaterialWords material = parse_material(o.material, registry);
  const SceneDescription others = scene_of_materials(registry);
  const auto sets = parameter_sets(material, o);
  ThreadPool pool;
  const ConsoleLog log;
  const RefusingLog refusing;
  ConformReport report{.material = fmt::format("{}", fmt::join(o.material, " ")),
                       .wavelengths_nm = parse_numbers("--wavelengths", o.wavelengths),
                       .effort = effort_of(o),
                       .false_alarm_rate = o.false_alarm_rate,
                       .findings = {}};
  for (const GivenWavelengths& wavelengths : in_lanes(report.wavelengths_nm)) {
    SceneResolver resolver(others, registry, wavelengths, refusing);
    const Preparation preparation{wavelengths, pool, log, {}};
    const Findings findings =
        examine(material.info, sets, {preparation, resolver, o.claims, report.effort, is_asked_for(material, o)});
    report.findings.insert(report.findings.end(), findings.begin(), findings.end());
  }
  report.level = judge(report.findings, o.false_alarm_rate);
  return report;
}

void conform(const ConformOptions& o) {
  if (!o.json.empty()) check_text_output(o.json);
  if (!o.picture.empty()) check_chart(o.picture);
  const ConformReport report = examine_material(o);
  if (o.json != "-") write_text("-", conform_text(report));
  if (!o.json.empty()) write_text(o.json, conform_json(report));
  if (!o.picture.empty()) {
    const Finding* finding = finding_to_draw(report);
    if (!finding) fail({}, "{}: nothing that was found out has directions to draw", o.picture);
    write_chart(o.picture, sphere_chart(*finding));
  }
  if (!report.all_hold()) throw CLI::RuntimeError(kBroken);
}

}  // namespace

void add_conform_command(CLI::App& app) {
  auto* command = app.add_subcommand(
      "conform", "Test whether a material obeys the laws of scattering. Exit code 0: it does; 2: a law is broken.");
  auto o = std::make_shared<ConformOptions>();
  command->add_option("material", o->material, "NAME parameter=value ...")->type_name("MATERIAL")->required();
  add_plugin_option(*command, o->plugins);
  command->add_flag("--sweep", o->sweep, "Also over the declared ranges of the parameters that are not given.");
  command->add_option("--samples", o->samples, "Samples for each direction; 20000 by default.");
  command->add_option("--angles", o->angles,
                      "Of wo from the normal, degrees, on both sides; 0,30,60,80,89 by default.");
  command->add_option("--wavelengths", o->wavelengths, "nm; 608,551,455 by default. Four at a time go together.");
  command->add_option("--seed", o->seed, "Seed of all random numbers.")->check(is_seed);
  command->add_flag("--lossless", o->claims.lossless, "Claim that these parameters absorb nothing: as much comes out.");
  command->add_flag("--reciprocal", o->claims.reciprocal, "Claim f(a, b) = f(b, a), beside what the material claims.");
  command
      ->add_option("--false-alarm-rate", o->false_alarm_rate,
                   "Chance that a law is called broken though all hold; 1e-6 by default.")
      ->check(is_within({1e-12, 0.5}));
  command->add_option("--json", o->json, "File for everything that was found; - for standard output, in place of text.")
      ->type_name("FILE");
  command
      ->add_option("--picture", o->picture,
                   "Map of the directions of the worst finding, .svg or .png: where a law is broken.")
      ->type_name("FILE");
  command->callback([o] { conform(*o); });
}

}  // namespace frond
