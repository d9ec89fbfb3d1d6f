#include <fmt/ranges.h>

#include <algorithm>

#include "core/messages/counted.h"
#include "core/messages/excerpt.h"
#include "core/parallel.h"
#include "imports/scene_import.h"
#include "jobs/record/common_params.h"
#include "scene/format/plugin_text.h"
#include "system/lower_case.h"

namespace frond {

// `frond import`: a model of another program as a scene.

namespace {

using enum ArgumentKind;

/// Units and axes by their names in --unit and --up.
constexpr std::string_view kUnits[] = {"m", "cm", "mm", "inch"};
constexpr double kMetres[] = {1, 0.01, 0.001, 0.0254};
constexpr std::string_view kAxes[] = {"y", "z"};

constexpr JobParam kImportParams[] = {
    JobParam("model", text, "Model to read: .obj, .gltf or .glb.",
             {.type = "FILE", .path = PathUse::read, .positional = true, .required = true}),
    JobParam("output", text,
             "Scene file to write, .pbrt, with a camera and lights. Materials and shapes go to NAME-plant.pbrt beside "
             "it, meshes and images into the folder NAME-files. Without it the command lists what the model contains.",
             {.type = "FILE", .aliases = "o", .path = PathUse::write}),
    JobParam(
        "leaf", texts,
        "NAME=PLUGIN[,parameter=value...]: leaf material for the model's materials of this name, with * and ? for any "
        "characters, as in \"leaf*=leaf,specimen=maize\". A number that may be a texture can follow the brightness of "
        "the image of the model's colour: chlorophylla=@4:1 is 4 where it is black, 1 where it is white.",
        {.type = "SWAP"}),
    JobParam("unit", text, "Length unit of the model, which is converted to metres; by default m, glTF's unit.",
             {.type = "UNIT", .choices = kUnits, .excludes = "scale"}),
    JobParam("scale", real, "Metres for one unit of the model.", {.range = {1e-12, 1e12}}),
    JobParam("up", text, "Axis that is up in the model; z is up in the scene. By default y, glTF's axis.",
             {.type = "AXIS", .choices = kAxes}),
    JobParam(
        "textures", texts,
        "Folder with images of the model, beside those in the model's folder and below it. Images are searched for "
        "by their names.",
        {.type = "FOLDER", .path = PathUse::read}),
    JobParam("objects", flag,
             "Keep each object of the model as an object of the scene with its name, which frond flux --by instance "
             "measures. By default the meshes of a material are joined."),
    JobParam("single-sided", texts,
             "Material, by name with * and ?, whose leaves are two sheets, front and back: remove the second sheet.",
             {.type = "NAME"}),
    kStrictParam,
};

/// Parses `@BLACK:WHITE`. Throws InputError.
MappedParam mapped_param(const std::string& name, const std::string& value, const PluginInfo& info,
                         const std::string& rule) {
  const size_t colon = value.find(':');
  const auto black = parse_numbers(value.substr(1, colon == std::string::npos ? colon : colon - 1));
  const auto white = colon == std::string::npos ? std::nullopt : parse_numbers(value.substr(colon + 1));
  if (!black || !white || black->size() != 1 || white->size() != 1)
    fail({}, "{}: {}={} is {}=@BLACK:WHITE, its values where the image of the colour is black and white, as in @4:1",
         rule, name, value, name);
  const Param* const param = find_param(info, name);
  if (!param || param->kind != ParamKind::float_texture) {
    std::vector<std::string_view> names;
    for (const Param& p : info.params)
      if (p.kind == ParamKind::float_texture) names.push_back(p.name);
    fail({}, "{}: \"{}\" of \"{}\" takes no texture; those that do are {}", rule, name, info.name,
         fmt::join(names, ", "));
  }
  for (const double v : {black->front(), white->front()})
    if (!param->range.contains(v))
      fail({}, "{}: \"{}\" lies within {:g} and {:g}, {:g} was given", rule, name, param->range.min, param->range.max,
           v);
  return {name, black->front(), white->front()};
}

/// Parses --leaf. Throws InputError.
std::vector<MaterialRule> rules_of(const JobRun& run) {
  std::vector<MaterialRule> rules;
  const Registry& registry = run.session().registry();
  for (const std::string& text : run.args.texts("leaf")) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      fail({}, "{} takes NAME=PLUGIN[,parameter=value...], \"{}\" was given", run.args.spelled("leaf"), text);
    MaterialRule rule{.pattern = text.substr(0, equals), .material = {}, .text = run.args.spelled("leaf") + " " + text};
    PluginText words = parse_plugin_text(text.substr(equals + 1), {});
    const MaterialInfo& info = registry.materials.get(words.name, {});
    std::erase_if(words.params, [&](const auto& p) {
      if (!p.second.starts_with('@')) return false;
      rule.mapped.push_back(mapped_param(p.first, p.second, info, rule.text));
      return true;
    });
    rule.material.name = words.name;
    set_params(words, info, {}, rule.material);
    rules.push_back(std::move(rule));
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
  if (lower_case(options.model.extension().string()) != ".obj") return;
  std::vector<std::string> assumed;
  if (!run.args.given("unit") && !run.args.given("scale"))
    assumed.push_back(fmt::format("its unit is taken as m ({})", run.args.spelled("unit")));
  if (!run.args.given("up")) assumed.push_back(fmt::format("y as up ({})", run.args.spelled("up")));
  if (!assumed.empty())
    run.log().info(fmt::format("{} is OBJ, which does not state them: {}; the plant is {:.4g} m high",
                               escaped(options.model.filename().string()), fmt::join(assumed, " and "),
                               summary.size[2]));
}

/// Warns of a height that no plant has.
void report_unit(const JobRun& run, const ImportSummary& summary) {
  constexpr double kTallest = 150, kLeast = 1e-3;  // m; the tallest tree has 116
  const double height = summary.size[2], largest = std::ranges::max(summary.size);
  if (run.args.given("unit") || run.args.given("scale") || (height <= kTallest && largest >= kLeast)) return;
  std::vector<std::string> offers;
  for (size_t i = 1; i < std::size(kUnits); ++i)
    if (height > kTallest) offers.push_back(fmt::format("{} makes it {:.3g} m", kUnits[i], height * kMetres[i]));
  if (offers.empty()) offers.push_back(fmt::format("{} takes metres for one unit", run.args.spelled("scale")));
  run.log().warn({}, fmt::format("the model is {:.4g} m {}, which no plant is: {} {}",
                                 height > kTallest ? height : largest, height > kTallest ? "high" : "large",
                                 height > kTallest ? run.args.spelled("unit") : "", fmt::join(offers, ", ")));
}

/// Reports what a material by --leaf replaces, and how its colour image can vary the leaf.
void report_replaced(const JobRun& run, const ImportSummary& summary) {
  if (summary.replaced.empty()) return;
  std::string text = fmt::format(
      "without effect under {}, since the tissue of a leaf decides its look: {}; alpha and "
      "normal maps are kept",
      run.args.spelled("leaf"), fmt::join(summary.replaced, ", "));
  const auto is_color = [](const std::string& what) { return what.starts_with("colour image"); };
  if (std::ranges::any_of(summary.replaced, is_color))
    text += fmt::format(
        "; chlorophylla=@4:1 in {} lets the chlorophyll follow the brightness of that image, from 4 where "
        "it is black to 1 where it is white",
        run.args.spelled("leaf"));
  run.log().info(text);
}

/// A warning for leaf materials, which --leaf has given; otherwise a note.
void report_double_sheets(const JobRun& run, const ImportOptions& options, const ImportSummary& summary) {
  for (const DoubleSheet& sheet : summary.double_sheets) {
    const std::string& name = summary.materials[sheet.material];
    const auto fits = [&name](const std::string& pattern) { return matches_pattern(pattern, name); };
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
  // Images only: no other file is read outside the model's folder.
  options.textures = run.args.texts("textures");
  options.z_is_up = run.args.text("up") == "z";
  options.keeps_objects = run.args.flag("objects");
  options.single_sided = run.args.texts("single-sided");
  const auto accept = [&](const ImportSummary& found) {
    report_assumptions(run, options, found);
    report_unit(run, found);
    report_replaced(run, found);
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
  const bool is_list = options.scene.empty();
  Result result{.tables = {{"materials"}, {"objects"}}};
  constexpr std::string_view kImages[] = {"color_image", "alpha_image", "normal_map"};
  for (size_t i = 0; i < summary.materials.size(); ++i) {
    if (summary.triangles[i] == 0) continue;
    result.tables[0].add("material", summary.materials[i]);
    result.tables[0].add("type", summary.types[i]);
    result.tables[0].add("triangles", double(summary.triangles[i]));
    result.text += fmt::format("{}: {}, {} triangle{}", summary.materials[i], summary.types[i], summary.triangles[i],
                               summary.triangles[i] == 1 ? "" : "s");
    for (size_t k = 0; k < std::size(kImages); ++k) {
      const std::string& image = summary.images[i][k];
      constexpr std::string_view kWords[] = {"colour", "alpha", "normals"};
      result.tables[0].add(std::string(kImages[k]), image);
      if (is_list && !image.empty()) result.text += fmt::format(", {} from {}", kWords[k], escaped(image));
    }
    result.text += '\n';
  }
  for (const ImportedObject& object : summary.object_list) {
    result.tables[1].add("object", object.name);
    result.tables[1].add("triangles", double(object.triangles));
    result.tables[1].add("instances", double(object.instances));
  }
  constexpr size_t kMostListed = 20;
  for (size_t i = 0; is_list && i < std::min(kMostListed, summary.object_list.size()); ++i)
    result.text += fmt::format("object {}: {}, {}\n", escaped(summary.object_list[i].name),
                               counted(summary.object_list[i].triangles, "triangle"),
                               counted(summary.object_list[i].instances, "instance"));
  if (summary.objects > 0)
    result.text +=
        fmt::format("{} of {}\n", counted(summary.instances, "instance"), counted(summary.objects, "object"));
  if (summary.has_camera) result.text += "the model's camera\n";
  if (summary.lights > 0) result.text += fmt::format("{} in place of sun and sky\n", counted(summary.lights, "light"));
  if (is_list) {
    const auto& [least, size] = std::pair(summary.least, summary.size);
    for (size_t k = 0; k < 3; ++k)
      result.text +=
          fmt::format("{}: {:.4g} to {:.4g} m\n", std::string_view("xyz").substr(k, 1), least[k], least[k] + size[k]);
    result.text += fmt::format("nothing is written: {} SCENE.pbrt writes a scene\n", run.args.spelled("output"));
  } else {
    result.text += fmt::format("{}: {:.4g} x {:.4g} x {:.4g} m\n", options.scene.string(), summary.size[0],
                               summary.size[1], summary.size[2]);
  }
  result.facts = {{"width", summary.size[0]},
                  {"depth", summary.size[1]},
                  {"height", summary.size[2]},
                  {"instances", double(summary.instances)},
                  {"lights", double(summary.lights)}};
  return result;
}

}  // namespace

extern const JobInfo kImportJob(
    "import", "Scenes", "Write a plant model of another program, OBJ or glTF, as a scene, or list what it contains.",
    "The model is read in a process of its own; files that it names are read in its folder and below only. Names of "
    "materials, their colours, opacity and normal maps, and instances are kept.",
    kImportParams, SessionUse::plugins, import_model);

}  // namespace frond
