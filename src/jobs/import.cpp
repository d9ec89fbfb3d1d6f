#include <fmt/ranges.h>

#include <algorithm>

#include "core/messages/counted.h"
#include "core/messages/excerpt.h"
#include "core/parallel.h"
#include "imports/scene_import.h"
#include "jobs/record/common_params.h"
#include "render/material_words.h"

namespace frond {

// `frond import`: a model of another program as a scene.

namespace {

using enum ArgumentKind;

/// Units and axes by their names in --unit and --up.
constexpr std::string_view kUnits[] = {"m", "cm", "mm", "inch"};
constexpr double kMetres[] = {1, 0.01, 0.001, 0.0254};
constexpr std::string_view kAxes[] = {"y", "z"};

constexpr JobParam kParams[] = {
    JobParam("model", text, "Model to read: .obj, .gltf or .glb.",
             {.type = "FILE", .path = PathUse::read, .positional = true, .required = true}),
    JobParam("output", text,
             "Scene file to write, .pbrt, with a camera and lights. Materials and shapes go to NAME-plant.pbrt beside "
             "it, meshes and images into the folder NAME-files.",
             {.type = "FILE", .aliases = "o", .path = PathUse::write, .required = true}),
    JobParam(
        "leaf", texts,
        "NAME=PLUGIN[,parameter=value...]: leaf material for the model's materials of this name, with * and ? for any "
        "characters, as in \"leaf*=leaf,specimen=maize\".",
        {.type = "SWAP"}),
    JobParam("unit", text, "Length unit of the model, which is converted to metres; by default m, glTF's unit.",
             {.type = "UNIT", .choices = kUnits, .excludes = "scale"}),
    JobParam("scale", real, "Metres for one unit of the model.", {.range = {1e-12, 1e12}}),
    JobParam("up", text, "Axis that is up in the model; z is up in the scene. By default y, glTF's axis.",
             {.type = "AXIS", .choices = kAxes}),
    JobParam("single-sided", texts,
             "Material, by name with * and ?, whose leaves are two sheets, front and back: remove the second sheet.",
             {.type = "NAME"}),
    kStrictParam,
};

/// Parses --leaf. Throws InputError.
std::vector<MaterialRule> rules_of(const JobRun& run) {
  std::vector<MaterialRule> rules;
  for (const std::string& text : run.args.texts("leaf")) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      fail({}, "{} takes NAME=PLUGIN[,parameter=value...], \"{}\" was given", run.args.spelled("leaf"), text);
    rules.push_back({text.substr(0, equals), parse_material(text.substr(equals + 1), run.session().registry()).plugin,
                     run.args.spelled("leaf") + " " + text});
  }
  return rules;
}

/// Returns metres for one unit of the model, by --scale or --unit.
double scale_of(const JobRun& run) {
  if (run.args.given("scale")) return run.args.real("scale");
  if (!run.args.given("unit")) return 1;
  return kMetres[std::ranges::find(kUnits, run.args.text("unit")) - std::begin(kUnits)];
}

/// Reports what the file does not state: OBJ has neither unit nor axis.
void report_assumptions(const JobRun& run, const ImportOptions& options, const ImportSummary& summary) {
  std::string extension = options.model.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  if (extension != ".obj") return;
  std::vector<std::string> assumed;
  if (!run.args.given("unit") && !run.args.given("scale"))
    assumed.push_back(fmt::format("its unit is taken as m ({})", run.args.spelled("unit")));
  if (!run.args.given("up")) assumed.push_back(fmt::format("y as up ({})", run.args.spelled("up")));
  if (!assumed.empty())
    run.log().info(fmt::format("{} is OBJ, which does not state them: {}; the plant is {:.4g} m high",
                               escaped(options.model.filename().string()), fmt::join(assumed, " and "),
                               summary.size[2]));
}

/// A warning for leaf materials, which --leaf has given; otherwise a note.
void report_double_sheets(const JobRun& run, const ImportOptions& options, const ImportSummary& summary) {
  for (const DoubleSheet& sheet : summary.double_sheets) {
    const std::string& name = summary.materials[sheet.material];
    const auto fits = [&name](const std::string& pattern) { return matches(pattern, name); };
    const std::string what = fmt::format(
        "\"{}\" has sheets that are there twice, front and back, {}; triangles of the second one: {}", name,
        sheet.apart > 0 ? fmt::format("up to {:.2g} m apart", sheet.apart) : "in the same place", sheet.triangles);
    const std::string fix = fmt::format("; {} \"{}\" removes them", run.args.spelled("single-sided"), name);
    if (std::ranges::any_of(options.single_sided, fits))
      run.log().info(what + ", removed");
    else if (std::ranges::any_of(options.rules, fits, &MaterialRule::pattern))
      run.log().warn({}, what + ". A leaf material is both faces of a leaf: light would pass two leaves" + fix);
    else
      run.log().info(what + fix);
  }
}

/// The job: reads the model, writes the scene, and reports what has no counterpart.
Result import_model(const JobRun& run) {
  const StopScope stop(run.control.stop);
  ImportOptions options{.model = run.args.text("model"), .scene = run.args.text("output"), .rules = rules_of(run)};
  options.scale = scale_of(run);
  options.z_is_up = run.args.text("up") == "z";
  options.single_sided = run.args.texts("single-sided");
  const auto accept = [&](const ImportSummary& found) {
    report_assumptions(run, options, found);
    report_double_sheets(run, options, found);
    if (!found.left_out.empty()) run.log().warn({}, fmt::format("left out: {}", fmt::join(found.left_out, ", ")));
    run.context.log().check();
    run.check_stop();
  };
  // The files are written after `accept`, so that a warning in strict mode leaves none.
  ImportSummary summary;
  try {
    summary = import_scene(options, run.log(), accept);
  } catch (const InputError&) {
    run.check_stop();  // Ctrl-C ends the process that reads the model
    throw;
  }
  Result result{.tables = {{"materials"}}};
  for (size_t i = 0; i < summary.materials.size(); ++i) {
    if (summary.triangles[i] == 0) continue;
    result.tables[0].add("material", summary.materials[i]);
    result.tables[0].add("type", summary.types[i]);
    result.tables[0].add("triangles", double(summary.triangles[i]));
    result.text += fmt::format("{}: {}, {} triangle{}\n", summary.materials[i], summary.types[i], summary.triangles[i],
                               summary.triangles[i] == 1 ? "" : "s");
  }
  if (summary.objects > 0)
    result.text +=
        fmt::format("{} of {}\n", counted(summary.instances, "instance"), counted(summary.objects, "object"));
  result.text += fmt::format("{}: {:.4g} x {:.4g} x {:.4g} m\n", options.scene.string(), summary.size[0],
                             summary.size[1], summary.size[2]);
  result.facts = {{"width", summary.size[0]},
                  {"depth", summary.size[1]},
                  {"height", summary.size[2]},
                  {"instances", double(summary.instances)}};
  return result;
}

}  // namespace

extern const JobInfo kImportJob(
    "import", "Scenes", "Write a plant model of another program, OBJ or glTF, as a scene.",
    "The model is read in a process of its own; files that it names are read in its folder and below only. Names of "
    "materials, their colours, opacity and normal maps, and instances are kept.",
    kParams, SessionUse::plugins, import_model);

}  // namespace frond
