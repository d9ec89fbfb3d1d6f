#pragma once

#include "jobs/record/job.h"
#include "scene/format/unsupported.h"
#include "scene/overrides.h"

/// Parameters that several jobs share, with one name and one meaning, and the functions that evaluate them.
namespace frond {

inline constexpr JobParam kSceneParam(
    "scene", ArgumentKind::text, "Scene file (pbrt-v4 format).",
    {.type = "SCENE", .path = PathUse::read, .scene = true, .decides = true, .positional = true, .required = true});
/// Returns a positional parameter for images or parts to read: `count` files, or any number if 0.
constexpr JobParam files_param(std::string_view name, std::string_view doc, size_t count = 0) {
  return JobParam(name, ArgumentKind::texts, doc,
                  {.type = "FILE", .values = count, .path = PathUse::read, .positional = true, .required = true});
}
/// Returns -o, --output: a file to write.
constexpr JobParam output_param(std::string_view doc, bool required, std::string_view excludes = "") {
  return JobParam("output", ArgumentKind::text, doc,
                  {.type = "FILE", .aliases = "o", .path = PathUse::write, .required = required, .excludes = excludes});
}
/// Returns the name of a binary file to write. Throws InputError for "-", standard output.
std::string binary_file_of(const Arguments& args, std::string_view name);
inline constexpr JobParam kSwapParam(
    "swap", ArgumentKind::texts,
    "MATERIAL=PLUGIN[,parameter=value...]: replace a material by another model; \"*=PLUGIN\" replaces every leaf.",
    {.type = "SWAP", .decides = true});
inline constexpr JobParam kIntegratorParam("integrator", ArgumentKind::text,
                                           "PLUGIN[,parameter=value...]: integrator; parameters that are not given "
                                           "keep the scene's values if the type is the scene's.",
                                           {.type = "INTEGRATOR", .decides = true});
inline constexpr JobParam kSeedParam("seed", ArgumentKind::seed, "Seed of all random numbers.", {.decides = true});
inline constexpr JobParam kIgnoreUnsupportedParam(
    "ignore-unsupported", ArgumentKind::text,
    "Leave out features of pbrt-v4 that frond lacks, or use the nearest one, with a warning: all of them, or a "
    "list of materials, cameras, textures, films, displacement.",
    {.type = "KINDS", .decides = true, .implied = "all"});
inline constexpr JobParam kStrictParam("strict", ArgumentKind::flag, "Treat warnings as errors.");
inline constexpr JobParam kTimeLimitParam("time-limit", ArgumentKind::real,
                                          "Time after which the job ends and returns its partial result.",
                                          {.unit = "s", .range = kAboveZero});
inline constexpr JobParam kCsvParam("csv", ArgumentKind::text, "CSV file to write; - is standard output.",
                                    {.type = "FILE", .path = PathUse::write});
inline constexpr JobParam kJsonParam("json", ArgumentKind::text, "JSON file to write; - is standard output.",
                                     {.type = "FILE", .path = PathUse::write});
inline constexpr JobParam kProvenanceParam(
    "provenance", ArgumentKind::flag,
    "Begin CSV files with comment lines: version, command, seed, and hash of the scene. JSON always has them.",
    {.needs = "csv"});
/// Returns a parameter for a chart to write, .svg or .png. `doc` names the chart's content.
constexpr JobParam chart_param(std::string_view name, std::string_view doc, std::string_view aliases = "") {
  return JobParam(name, ArgumentKind::text, doc, {.type = "CHART", .aliases = aliases, .path = PathUse::write});
}

inline constexpr JobParam kMaterialParam("material", ArgumentKind::texts,
                                         "NAME[,parameter=value...]: material, as in leaf,specimen=maize.",
                                         {.type = "MATERIAL", .decides = true, .positional = true, .required = true});
inline constexpr JobParam kWithParam("with", ArgumentKind::texts, "NAME[,parameter=value...]: one more material.",
                                     {.type = "MATERIAL", .decides = true});

/// Returns the job's material and those of --with, in the grammar of material_text.
std::vector<std::string> materials_of(const JobRun& run);
/// Returns the replacements by --swap. Throws InputError.
std::vector<MaterialSwap> swaps_of(const Arguments& args);
/// Returns the overrides by --swap, --wavelengths, --integrator, --filter, --for-denoiser, --seed and --quick; the
/// job may declare a subset. Throws InputError.
SceneOverrides overrides_of(const Arguments& args);
/// Writes the flags that set an Option into the scene; they override Options of the same name.
void apply_scene_flags(const Arguments& args, SceneDescription& description);
/// Returns the features that --ignore-unsupported lists. Throws InputError for an unknown one.
Unsupported unsupported_of(const Arguments& args);
/// Reads the job's scene and applies the overrides. Throws InputError or Problems with all errors of the scene.
SceneDescription described_scene(const JobRun& run);
/// Warns if --quiet is given and no output file, so that the job's result is lost.
void warn_if_nothing_is_kept(const JobRun& run);
/// Returns --wavelengths as a plug-in and its parameters: "smpte", "bands,wavelengths=450,550". Numbers alone, 450,550
/// or 400:700:10, become bands.
std::string wavelengths_text(const Arguments& args);
/// Throws InputError if the chart is given and its file name has no extension of a chart format.
void check_chart_param(const JobRun& run, std::string_view name);

}  // namespace frond
