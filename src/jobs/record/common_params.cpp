#include "jobs/record/common_params.h"

#include <fmt/ranges.h>

#include "report/chart.h"

namespace frond {
namespace {

/// Parses "leaf=MODEL" or "leaf=MODEL,parameter=value". Throws InputError.
MaterialSwap parse_swap(const std::string& text, const Arguments& args) {
  const std::string option = args.spelled("swap");
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    fail({}, "{} takes MATERIAL=PLUGIN[,parameter=value...], \"{}\" was given", option, text);
  const Location where{std::make_shared<const std::string>(option + " " + text)};
  return {text.substr(0, equals), parse_plugin_text(text.substr(equals + 1), where), where};
}

/// Returns the plug-in of an option. Errors name the option.
PluginText plugin_of(const Arguments& args, std::string_view name) {
  return parse_plugin_text(args.text(name), {std::make_shared<const std::string>(args.spelled(name))});
}

bool has(const Arguments& args, std::string_view name) { return args.declares(name) && args.given(name); }

}  // namespace

std::string binary_file_of(const Arguments& args, std::string_view name) {
  std::string file = args.text(name);
  if (file == "-") fail({}, "{} - would write a binary file to standard output: name a file", args.spelled(name));
  return file;
}

std::vector<std::string> materials_of(const JobRun& run) {
  std::vector<std::string> texts{material_text(run.args.texts("material"))};
  if (has(run.args, "with"))
    for (const std::string& text : run.args.texts("with")) texts.push_back(material_text({text}));
  return texts;
}

std::vector<MaterialSwap> swaps_of(const Arguments& args) {
  std::vector<MaterialSwap> swaps;
  for (const std::string& text : args.texts("swap")) {
    MaterialSwap swap = parse_swap(text, args);
    if (std::ranges::find(swaps, swap.from, &MaterialSwap::from) != swaps.end())
      fail({}, "{} replaces \"{}\" twice", args.spelled("swap"), swap.from);
    swaps.push_back(std::move(swap));
  }
  return swaps;
}

/// Jobs declare different subsets of the parameters; undeclared ones are skipped.
SceneOverrides overrides_of(const Arguments& args) {
  SceneOverrides overrides;
  if (has(args, "swap")) overrides.swaps = swaps_of(args);
  if (args.declares("wavelengths")) overrides.wavelengths = wavelengths_text(args);
  if (has(args, "integrator")) overrides.integrator = plugin_of(args, "integrator");
  if (has(args, "filter")) overrides.filter = plugin_of(args, "filter");
  overrides.separate_pixels = args.declares("for-denoiser") && args.flag("for-denoiser");
  if (overrides.separate_pixels && overrides.filter)
    for (const auto& [name, value] : overrides.filter->params)
      if (name == "reconstruction" && value != "importance")
        fail({}, "{} means \"reconstruction=importance\": {} asks for \"{}\"", args.spelled("for-denoiser"),
             args.spelled("filter"), value);
  if (has(args, "seed")) overrides.seed = args.seed("seed");
  overrides.quick = args.declares("quick") && args.flag("quick");
  return overrides;
}

void apply_scene_flags(const Arguments& args, SceneDescription& description) {
  constexpr std::pair<const char*, const char*> kSceneOptions[] = {
      {"disable-pixel-jitter", "disablepixeljitter"},
      {"disable-texture-filtering", "disabletexturefiltering"},
      {"disable-wavelength-jitter", "disablewavelengthjitter"}};
  for (const auto& [flag, option] : kSceneOptions) {
    if (!args.flag(flag)) continue;
    std::erase_if(description.options, [name = option](const ParsedParam& p) { return p.name == name; });
    description.options.push_back({"bool", option, {}, {}, std::vector<bool>{true}});
  }
}

Unsupported unsupported_of(const Arguments& args) {
  return args.given("ignore-unsupported") ? Unsupported(args.text("ignore-unsupported")) : Unsupported();
}

SceneDescription described_scene(const JobRun& run) {
  SceneDescription description = read_scene(run, scenes_of(run).front());
  description.is_quick = false;  // of an image, which a measurement has none of
  apply_overrides(overrides_of(run.args), description, run.session().registry(), run.log());
  return description;
}

/// Text that begins with a digit is a list of bands; other text names a strategy.
/// Numbers are short for the strategy "bands"; an empty text is refused, because it would mean the scene's own
/// strategy.
std::string wavelengths_text(const Arguments& args) {
  const std::string text = args.text("wavelengths");
  if (text.empty() && args.given("wavelengths"))
    fail({}, "{}: a list of wavelengths, as in 450,550 or 400:700:10, or a plug-in is needed",
         args.spelled("wavelengths"));
  if (text.empty() || std::string_view("0123456789.").find(text[0]) == std::string_view::npos) return text;
  const auto numbers = parse_numbers(text);
  if (!numbers)
    fail({}, "{}: {} is neither a list of wavelengths, as in 450,550 or 400:700:10, nor a plug-in{}",
         args.spelled("wavelengths"), text, range_hint(text, "nm"));
  if (const std::string hint = range_hint(text, "nm"); !hint.empty())
    fail({}, "{}: {} nm was given{}", args.spelled("wavelengths"), text, hint);
  return fmt::format("bands,wavelengths={}", fmt::join(*numbers, ","));
}

void warn_if_nothing_is_kept(const JobRun& run) {
  if (!run.args.declares("quiet") || !run.args.flag("quiet")) return;
  std::vector<std::string> outputs;
  for (const JobParam* p : run.args.params()) {
    if (p->path != PathUse::write || p->name == "cache") continue;
    if (run.args.given(p->name)) return;
    outputs.push_back(run.args.spelled(p->name));
  }
  run.log().warn({}, fmt::format("{} prints no result, and no file is written: nothing is kept; {} keeps it",
                                 run.args.spelled("quiet"), fmt::join(outputs, " or ")));
}

/// Checked before the measurement, which may take hours.
void check_chart_param(const JobRun& run, std::string_view name) {
  if (run.args.given(name)) check_chart(run.args.text(name));
}

}  // namespace frond
