#include "cli/radiometer_options.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "cli/common_options.h"
#include "cli/number_list.h"
#include "cli/render_options.h"
#include "system/atomic_file.h"

namespace frond {

void add_radiometer_options(CLI::App& command, RadiometerOptions& o, const std::string& paths) {
  command.add_option("scene", o.scene, "Scene file.")->type_name("SCENE")->required();
  command.add_option("--wavelengths", o.wavelengths,
                     "nm, as in 450,550,670 or 400:700:10, or bands,responses=...; 450,550,670,800 by default.");
  command
      .add_option("--target", o.target,
                  "x0,x1,y0,y1,z of the rectangle that is measured; one period, or the whole scene, at its top by "
                  "default.")
      ->delimiter(',')
      ->expected(5);
  command.add_option("--period", o.period, "Lengths along x and y after which the scene is there again, for ever.")
      ->delimiter(',')
      ->expected(2);
  command.add_option("--paths", o.paths, paths);
  command.add_option("--rms", o.rms, "Until the standard errors, relative to their means, are below this (RMS).")
      ->check(is_positive);
  command.add_option("--time-limit", o.time_limit_seconds, "End after so many seconds, with what there is then.")
      ->check(is_positive);
  auto* csv = command.add_option("--csv", o.csv, "CSV file; - is standard output.")->type_name("FILE");
  command
      .add_option("--checkpoint", o.checkpoint_seconds,
                  "Every so many seconds, and when stopped by SIGINT or SIGTERM, keep what is done in CSV.part.")
      ->needs(csv)
      ->check(is_positive);
  command.add_flag("--resume", o.resume, "Go on from CSV.part, where there is one; keeps one too.")->needs(csv);
  command
      .add_option("--swap", o.swaps,
                  "MATERIAL=PLUGIN[,parameter=value...]: another model; \"*=PLUGIN\": for every leaf.")
      ->type_name("SWAP")
      ->allow_extra_args(false);
  command.add_option("--integrator", o.integrator, "PLUGIN[,parameter=value...], in place of paths of any length.")
      ->type_name("INTEGRATOR");
  command.add_option("--seed", o.seed, "Seed of all random numbers.")->check(is_seed);
  command.add_option("--threads", o.threads, "Threads; all by default. The figures do not depend on it.")
      ->check(CLI::Range(1, 1024));
  add_plugin_option(command, o.plugins);
  add_reading_options(command, o.reading);
  command.add_option("--cache", o.cache, "Folder for tables computed at load; ~/.cache/frond by default.")
      ->type_name("FOLDER");
  command.add_flag("--no-cache", o.no_cache, "Keep no tables on disk.");
  command.add_flag("-q,--quiet", o.quiet, "Print nothing but errors and what is asked for.");
}

std::string wavelengths_of(const RadiometerOptions& o) {
  if (o.wavelengths.starts_with("bands")) return o.wavelengths;
  return fmt::format("bands,wavelengths={}", fmt::join(parse_numbers("--wavelengths", o.wavelengths), ","));
}

std::optional<Target> target_of(const RadiometerOptions& o) {
  if (o.target.empty()) return {};
  const Target t{o.target[0], o.target[1], o.target[2], o.target[3], o.target[4]};
  if (!(t.x0 < t.x1 && t.y0 < t.y1)) fail({}, "--target takes x0,x1,y0,y1,z: {} is empty", fmt::join(o.target, ","));
  return t;
}

std::optional<std::array<double, 2>> period_of(const RadiometerOptions& o) {
  if (o.period.empty()) return {};
  return std::array{o.period[0], o.period[1]};
}

SceneDescription scene_of(const RadiometerOptions& o, const Session& session) {
  SceneOverrides overrides;
  overrides.swaps = swaps_of(o.swaps);
  if (!o.integrator.empty()) overrides.integrator = parse_plugin_text(o.integrator, {});
  overrides.seed = o.seed;
  SceneDescription description = session.read(o.scene, unsupported_of(o.reading));
  apply_overrides(overrides, description, session.registry(), session.log());
  return description;
}

SessionOptions session_options_of(const RadiometerOptions& o) {
  return {o.threads, cache_directory(o.cache, o.no_cache), o.plugins};
}

std::unique_ptr<KeptFile> kept_file_of(const RadiometerOptions& o, const Log& log) {
  if (o.checkpoint_seconds == 0 && !o.resume) return {};
  if (o.csv == "-") fail({}, "--checkpoint and --resume keep a file beside that of --csv: standard output has none");
  const std::string part = o.csv + ".part";
  check_replaceable(part);
  return std::make_unique<KeptFile>(KeptFile::Names{part, part}, log);
}

}  // namespace frond
