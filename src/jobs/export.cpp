#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/messages/problems.h"
#include "exports/exported_bsdf.h"
#include "exports/format.h"
#include "exports/mitsuba/scene_export.h"
#include "instruments/given_wavelengths.h"
#include "jobs/record/common_params.h"
#include "radiometry/radiometer_scene.h"
#include "render/measured_material.h"
#include "report/text_output.h"
#include "system/atomic_file.h"

namespace frond {

// `frond export`: BSDFs, or a scene, for other renderers and programs (docs/other_renderers.md).

namespace {

using enum ArgumentKind;

constexpr Interval kBelowHorizon_deg{0, 89.9999};

/// The format of a whole scene; all others are formats of a material.
constexpr std::string_view kMitsuba = "mitsuba";

/// Returns the names of all export formats: "radiance", "csv", ...
std::vector<std::string_view> format_names() {
  std::vector<std::string_view> names{kMitsuba};
  for (const ExportFormat* format : export_formats()) names.push_back(format->name);
  return names;
}

/// Returns the help of --format, which is assembled from the formats' own descriptions.
std::string format_doc() {
  std::string doc = "File format. mitsuba: a scene for Mitsuba 3, as a folder.";
  for (const ExportFormat* format : export_formats()) doc += fmt::format(" {}: {}.", format->name, format->doc);
  return doc;
}

const std::vector<std::string_view> kFormatNames = format_names();
const std::string kFormatDoc = format_doc();

const JobParam kExportParams[] = {
    JobParam(
        "material", texts,
        "NAME[,parameter=value...]: material, as in leaf,specimen=maize; for mitsuba a scene file (pbrt-v4 format).",
        {.type = "MATERIAL|SCENE", .scene = true, .decides = true, .positional = true, .required = true}),
    JobParam("format", text, kFormatDoc, {.choices = kFormatNames, .decides = true, .required = true}),
    JobParam("output", text, "File to write; - is standard output, for text formats only. For mitsuba a folder.",
             {.type = "FILE|FOLDER", .aliases = "o", .path = PathUse::write, .required = true}),
    JobParam(
        "wavelengths", numbers,
        "Wavelengths, ascending; for osl those of red,green,blue, also for gltf and materialx where three are given, "
        "else samples of the visible spectrum (by default 380:780:10). For mitsuba one (mono variants), those of "
        "red,green,blue (rgb variants, by default 608,551,455) or more (spectral variants).",
        {.unit = "nm", .range = {360, 2500}, .decides = true}),
    JobParam("angles", numbers, "Angles between the normal and the light, on both sides, in a table.",
             {.unit = "degrees", .range = kBelowHorizon_deg, .decides = true, .quantity = PhysicalQuantity::angle}),
    JobParam("view-angles", numbers, "Angles between the normal and the viewer in a table.",
             {.unit = "degrees", .range = kBelowHorizon_deg, .decides = true, .quantity = PhysicalQuantity::angle}),
    JobParam("view-azimuths", numbers,
             "Azimuths from the light to the viewer in a table; the mirror direction is at 180.",
             {.unit = "degrees", .range = {0, 359.9999}, .decides = true}),
    JobParam("rays", count, "Number of rays for each value of R and T that is measured by rays.",
             {.range = {2, kCounts.max}, .decides = true}),
    kSeedParam,
    kSwapParam,
    JobParam(
        "ignore-unsupported", text,
        "For mitsuba: leave out what Mitsuba or frond lacks, or export the nearest, with a warning that states what "
        "is lost: all of it, or a list of materials, cameras, textures, films, displacement.",
        {.type = "KINDS", .decides = true, .implied = "all"}),
};

/// Throws InputErrors for all given options that the format does not use; the messages name the formats that do.
void check_arguments(const Arguments& args, const ExportFormat& format) {
  constexpr std::pair<std::string_view, ExportOption> kOptions[] = {{"angles", ExportOption::angles},
                                                                    {"view-angles", ExportOption::views},
                                                                    {"view-azimuths", ExportOption::views},
                                                                    {"rays", ExportOption::rays}};
  const auto uses = [](const ExportFormat& f, ExportOption option) {
    return std::ranges::count(f.options, option) > 0;
  };
  Problems problems;
  for (const auto& [name, option] : kOptions) {
    if (!args.given(name) || uses(format, option)) continue;
    std::vector<std::string_view> others;
    for (const ExportFormat* f : export_formats())
      if (uses(*f, option)) others.push_back(f->name);
    problems.add(InputError(
        {}, fmt::format("{} is for {} {}", args.spelled(name), args.spelled("format"), fmt::join(others, ", "))));
  }
  if (args.text("output") == "-" && !format.is_text)
    problems.add(InputError({}, fmt::format("{} {} is no text: it cannot be written to standard output",
                                            args.spelled("format"), format.name)));
  problems.check();
}

/// Throws InputErrors for options of materials' formats, or of scenes.
void check_options(const Arguments& args, bool is_scene) {
  constexpr std::string_view kOfMaterials[] = {"angles", "view-angles", "view-azimuths", "rays", "seed"},
                             kOfScenes[] = {"swap", "ignore-unsupported"};
  Problems problems;
  const auto reject = [&](std::string_view name, std::string_view what) {
    if (args.given(name))
      problems.add(InputError({}, fmt::format("{} {} {} mitsuba", args.spelled(name), what, args.spelled("format"))));
  };
  for (const std::string_view name : kOfMaterials)
    if (is_scene) reject(name, "has no effect with");
  for (const std::string_view name : kOfScenes)
    if (!is_scene) reject(name, "is for");
  problems.check();
}

/// Exports a scene.
Result export_scene(const JobRun& run) {
  const Arguments& args = run.args;
  const std::vector<std::string> files = args.texts("material");
  if (files.size() != 1) fail({}, "{} mitsuba takes one scene file, {} given", args.spelled("format"), files.size());
  if (args.text("output") == "-") fail({}, "{} mitsuba writes a folder, not standard output", args.spelled("format"));
  const std::vector<double> nm = args.numbers("wavelengths");
  if (nm.size() == 3 && std::ranges::is_sorted(nm))
    run.log().warn({}, fmt::format("{} {}: the first is red and the last is blue", args.spelled("wavelengths"),
                                   fmt::join(nm, ",")));
  Session& session = run.session();
  SceneDescription description = read_scene(run, scenes_of(run, "material").front());
  apply_swaps(description, swaps_of(args), session.registry(), run.log());
  export_to_mitsuba(std::move(description), session.registry(),
                    {args.text("output"), args.numbers("wavelengths"), files.front(), unsupported_of(args)},
                    session.pool(), run.log(), run.context.options().cache);
  return {};
}

/// The job: prepares the material in groups of wavelengths as the format requests them.
Result export_material(const JobRun& run) {
  const Arguments& args = run.args;
  const bool is_scene = args.text("format") == kMitsuba;
  check_options(args, is_scene);
  if (is_scene) return export_scene(run);
  if (!run.scenes.empty())
    fail({}, "{} {} takes a material, not a scene: {} mitsuba takes one", args.spelled("format"), args.text("format"),
         args.spelled("format"));
  const ExportFormat& format =
      **std::ranges::find(export_formats(), args.text("format"), [](const ExportFormat* f) { return f->name; });
  check_arguments(args, format);
  const ExportRequest request{args.numbers("wavelengths"), args.numbers("angles"), args.numbers("view-angles"),
                              args.numbers("view-azimuths"), args.count("rays")};
  format.check(request);
  if (args.text("output") != "-") check_replaceable(args.text("output"));
  const std::string material = material_text(args.texts("material"));
  Session& session = run.session();
  const auto prepare = [&](const std::vector<double>& nm) -> std::shared_ptr<const Material> {
    run.check_stop();
    return prepared_material(material, session.registry(), GivenWavelengths({nm.begin(), nm.end()}), session.pool(),
                             run.log(), run.context.options().cache, keep_energy);
  };
  if (const auto words = parse_material(material, session.registry());
      const ParsedParam* given = fluorescence_of(words.plugin))
    run.log().warn({}, fmt::format("\"{}\" is left out: {} {} holds no fluorescence", given->name,
                                   args.spelled("format"), format.name));
  const uint64_t seed = hash_key(args.seed("seed"), material_seed(material));
  write_text(args.text("output"), format.write({material, prepare, seed, session.pool(), run.log()}, request));
  return {};
}

}  // namespace

extern const JobInfo kExportJob("export", "Materials",
                                "Write a material's BSDF, or a scene, as files for other programs.", "", kExportParams,
                                SessionUse::all, export_material);

}  // namespace frond
