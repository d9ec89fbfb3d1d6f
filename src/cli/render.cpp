#include "integrators/render.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/choose/choice_report.h"
#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/output.h"
#include "cli/plugins.h"
#include "cli/progress.h"
#include "scene/parser.h"
#include "scene/scene.h"
#include "spectra/color_space.h"

namespace frond {
namespace {

struct RenderOptions {
  std::string scene, output, wavelengths, integrator, cache;
  std::vector<double> crop;
  std::vector<int> pixels;
  std::vector<std::string> swaps, plugins;
  DisplayChoice display;
  int samples = 0, threads = 0;
  uint64_t seed = 0;
  bool seed_given = false, quick = false, json = false, quiet = false, no_cache = false, pilot = false;
};

/// "leaf=abm" or "leaf=abm,mode=analog".
MaterialSwap parse_swap(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    fail({}, "--swap takes MATERIAL=PLUGIN[,parameter=value...], \"{}\" was given", text);
  const Location where{std::make_shared<const std::string>("--swap " + text)};
  return {text.substr(0, equals), parse_plugin_text(text.substr(equals + 1), where), where};
}

std::vector<MaterialSwap> swaps_of(const RenderOptions& options) {
  std::vector<MaterialSwap> swaps;
  for (const std::string& swap : options.swaps) swaps.push_back(parse_swap(swap));
  return swaps;
}

/// What of the film the command line asks for; the scene's crop if it says nothing.
Crop crop_of(const RenderOptions& o, const FilmSettings& film) {
  if (o.crop.empty() && o.pixels.empty()) return film.crop;
  const Crop crop = o.crop.empty() ? crop_of_pixels(o.pixels, film.width, film.height)
                                   : crop_of_fractions(o.crop, film.width, film.height);
  if (crop.width() <= 0 || crop.height() <= 0)
    fail({}, "{} holds no pixel of the {} x {} film: it takes x0,x1,y0,y1",
         o.crop.empty() ? fmt::format("--pixels {}", fmt::join(o.pixels, ","))
                        : fmt::format("--crop {}", fmt::join(o.crop, ",")),
         film.width, film.height);
  return crop;
}

SceneOverrides overrides_of(const RenderOptions& options) {
  SceneOverrides overrides;
  overrides.wavelengths = options.wavelengths;
  if (!options.integrator.empty()) overrides.integrator = parse_plugin_text(options.integrator, {});
  if (options.seed_given) overrides.seed = options.seed;
  overrides.cache_dir = cache_directory(options.cache, options.no_cache);
  overrides.quick = options.quick;
  return overrides;
}

/// One thing that was rendered, for people and for programs.
struct Report {
  RenderStatistics statistics;
  double load_seconds;
  int samples;
  double foliar_ratio;
  std::optional<choose::Choice> choice;
};

/// Counts by depth, as far as there are any.
std::vector<uint64_t> counts(std::span<const uint64_t> by_depth) {
  while (!by_depth.empty() && by_depth.back() == 0) by_depth = by_depth.first(by_depth.size() - 1);
  return {by_depth.begin(), by_depth.end()};
}

void print_report(const Report& r, const std::string& output, bool json) {
  const RenderStatistics& s = r.statistics;
  const double per_path = s.cpu_seconds / double(s.paths) * 1e6, rays_per_path = double(s.rays) / double(s.paths);
  if (json) {
    nlohmann::ordered_json j{{"output", output},
                             {"samples_per_pixel", r.samples},
                             {"load_seconds", r.load_seconds},
                             {"wall_seconds", s.wall_seconds},
                             {"cpu_seconds", s.cpu_seconds},
                             {"paths", s.paths},
                             {"rays", s.rays},
                             {"cpu_us_per_path", per_path},
                             {"rays_per_path", rays_per_path},
                             {"foliar_ratio", r.foliar_ratio},
                             {"paths_escaped_by_depth", counts(s.ends.escaped)},
                             {"paths_absorbed_by_depth", counts(s.ends.absorbed)}};
    if (r.choice) j["choice"] = nlohmann::ordered_json::parse(choose::choice_json(*r.choice));
    fmt::print("{}\n", j.dump(2));
    return;
  }
  fmt::print(stderr,
             "{}: {} samples per pixel in {:.2f} s ({:.2f} s of CPU, {:.3f} us and {:.2f} rays per path), loaded in "
             "{:.2f} s\n",
             output, r.samples, s.wall_seconds, s.cpu_seconds, per_path, rays_per_path, r.load_seconds);
  fmt::print(stderr, "foliar ratio {:.2f} %\n", 100 * r.foliar_ratio);
}

/// A ColorSpace directive decides the image's space too; without one the wavelength strategy's own serves, where that
/// was not chosen: what is chosen shall not change the space.
std::string output_space(const SceneDescription& description, const std::optional<choose::Choice>& choice) {
  const bool chosen = choice && !choice->answers.front().is_leaf;
  if (!description.color_space_where.file) return chosen ? "linear sRGB" : "";
  return std::string(color_space(description.color_space, description.color_space_where).linear_name);
}

/// Samples see a few bands each.
void check_samples(uint64_t samples, size_t bands) {
  const size_t needed = (bands + kLanes - 1) / kLanes;
  if (samples < needed)
    fail({}, "{} bands need {} samples per pixel at least, each of which sees {}: {} were asked for", bands, needed,
         kLanes, samples);
}

/// Writes what is chosen into the description and the overrides.
std::optional<choose::Choice> choose_models(const RenderOptions& options, const FilmSettings& film,
                                            const Registry& registry, SceneDescription& description,
                                            SceneOverrides& overrides, ThreadPool& pool, const Log& log) {
  const choose::Subject subject{description, registry, overrides, film, uint64_t(options.samples)};
  auto chosen = choose::choose_models(subject, choose::standard_ladder(registry), pool, log);
  if (!chosen) return {};
  log.info(choose::choice_text(chosen->choice));
  if (const std::string warning = choose::choice_warning(chosen->choice); !warning.empty()) log.warn({}, warning);
  description.materials = std::move(chosen->materials);
  overrides.wavelengths = chosen->wavelengths;
  return chosen->choice;
}

/// In place of a render. People have it in the log.
void print_choice(const std::optional<choose::Choice>& choice, bool json) {
  if (!choice) fail({}, "--pilot: the scene leaves no leaf's model open: Material \"leaf\" does, or --swap \"*=leaf\"");
  if (json) fmt::print("{}\n", nlohmann::ordered_json::parse(choose::choice_json(*choice)).dump(2));
}

void render_scene(const RenderOptions& options, const std::string& command_line) {
  auto start = std::chrono::steady_clock::now();
  const Log log(options.quiet);
  ThreadPool pool(options.threads);
  SceneDescription description = parse_scene(options.scene, log);
  const Registry registry = load_registry(options.plugins);
  apply_swaps(description, swaps_of(options), registry, log);
  SceneOverrides overrides = overrides_of(options);
  FilmSettings film_settings = Scene::film_settings(description, registry);
  film_settings.crop = crop_of(options, film_settings);
  if (options.quick) film_settings = halved(film_settings);
  // Refused now, not after an hour.
  const std::string output = options.output.empty() ? film_settings.filename : options.output;
  const ImageOutput writer(output, options.display);
  const WavelengthChoice wavelengths = wavelength_choice(description, overrides);
  writer.check_channels(make_wavelengths(wavelengths.text, wavelengths.where, description, registry)->film_space());

  const auto choice = choose_models(options, film_settings, registry, description, overrides, pool, log);
  if (options.pilot) return print_choice(choice, options.json);
  if (choice) start = std::chrono::steady_clock::now();  // its time is told apart
  const Scene scene(description, registry, overrides, pool, log);
  const int samples = options.samples > 0 ? options.samples : scene.samples_per_pixel();
  const double load_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto bands = scene.wavelengths().bands();
  OutputDetails details{.film_space = std::string(scene.wavelengths().film_space()),
                        .bands = {bands.begin(), bands.end()},
                        .color_space = output_space(description, choice),
                        .attributes = {{"frond:version", FROND_VERSION},
                                       {"frond:seed", std::to_string(scene.seed())},
                                       {"frond:samples", std::to_string(samples)},
                                       {"frond:wavelengths", scene.wavelengths_name()},
                                       {"frond:scene_hash", fmt::format("{:016x}", description.content_hash)},
                                       {"frond:command", command_line}}};
  if (choice) details.attributes.merge(choose::choice_attributes(*choice));
  writer.check(details);
  check_samples(uint64_t(samples), bands.size());
  Film film(film_settings, description.film.where, bands.size());
  const RenderJob job{
      scene, scene.camera(),   scene.integrator(), scene.wavelengths(), scene.filter(), scene.sampler(), scene.seed(),
      0,     uint64_t(samples)};
  RenderStatistics statistics;
  {
    ProgressLine line(options.quiet);
    statistics = render(job, film, pool, std::ref(line));
  }
  if (const int64_t count = film.not_finite(); count > 0)
    log.warn({}, fmt::format("{} of {} samples were too bright for a number, or none at all, and count as black", count,
                             statistics.paths));
  writer.write(film, details);
  if (!options.quiet || options.json)
    print_report({statistics, load_seconds, samples, film.foliar_ratio(), choice}, output, options.json);
}

/// What of the command decides the pixels: threads, paths and what is printed do not belong in a file's header.
std::string command_line_of(const RenderOptions& o) {
  std::string line = "frond render " + std::filesystem::path(o.scene).filename().string();
  if (o.samples > 0) line += fmt::format(" --spp {}", o.samples);
  if (o.seed_given) line += fmt::format(" --seed {}", o.seed);
  if (!o.wavelengths.empty()) line += " --wavelengths " + o.wavelengths;
  if (!o.integrator.empty()) line += " --integrator " + o.integrator;
  if (!o.crop.empty()) line += fmt::format(" --crop {}", fmt::join(o.crop, ","));
  if (!o.pixels.empty()) line += fmt::format(" --pixels {}", fmt::join(o.pixels, ","));
  for (const std::string& plugin : o.plugins) line += " --plugin " + std::filesystem::path(plugin).filename().string();
  for (const std::string& swap : o.swaps) line += " --swap " + swap;
  if (o.quick) line += " --quick";
  if (!o.display.display.empty()) line += " --display " + o.display.display;
  if (!o.display.view.empty()) line += " --view " + o.display.view;
  return line;
}

}  // namespace

void add_render_command(CLI::App& app) {
  auto options = std::make_shared<RenderOptions>();
  RenderOptions& o = *options;
  auto* command = app.add_subcommand("render", "Render a pbrt-v4 scene file.");
  command->add_option("scene", o.scene, "Scene file.")->required();
  command->add_option("-o,--output", o.output, "Image: .exr (linear), .png or .jpg (through the display transform).");
  add_count_option(*command, "--spp", o.samples, 1 << 30, "Samples per pixel, in place of the scene's.");
  command->add_option("--threads", o.threads, "Threads; all by default. The image does not depend on it.")
      ->check(CLI::Range(1, 1024));
  auto* seed = command->add_option("--seed", o.seed, "Seed of all random numbers.")->check(is_seed);
  auto* crop = command->add_option("--crop,--cropwindow", o.crop,
                                   "x0,x1,y0,y1 of what to render, as fractions of the film; ends are rounded up.");
  crop->delimiter(',')->expected(4)->check(is_within({0, 1}));
  auto* pixels = command->add_option("--pixels,--pixelbounds", o.pixels,
                                     "x0,x1,y0,y1 of what to render, in pixels; x1 and y1 are not in it.");
  pixels->delimiter(',')->expected(4)->check(is_pixel)->excludes(crop);
  command->add_option("--wavelengths", o.wavelengths,
                      "hero (also hero,lambdamin=400,lambdamax=700), meyer, smpte for the paper's three, or "
                      "bands,wavelengths=450,550,850 (also bands,lambdamin=400,lambdamax=1000,step=10).");
  command->add_option("--integrator", o.integrator,
                      "PLUGIN[,parameter=value...]; one of the scene's kind keeps the scene's other parameters.");
  command
      ->add_option("--swap", o.swaps,
                   "MATERIAL=PLUGIN[,parameter=value...]: another model; \"*=PLUGIN\": for every leaf.")
      ->allow_extra_args(false);
  add_plugin_option(*command, o.plugins);
  command->add_option("--display", o.display.display, "Display of PNG and JPEG output; sRGB by default.");
  command->add_option("--view", o.display.view, "View of that display.");
  command->add_option("--cache", o.cache, "Folder for tables computed at load; ~/.cache/frond by default.");
  command->add_flag("--no-cache", o.no_cache, "Keep no tables on disk.");
  command->add_flag("--quick", o.quick, "A first look: half the resolution, a sixteenth of the samples.");
  command->add_flag("--pilot", o.pilot, "Choose the models of open leaves, say which, and render nothing.");
  command->add_flag("--json", o.json, "Print the statistics as JSON on standard output.");
  command->add_flag("-q,--quiet", o.quiet, "Print nothing but errors.");
  command->callback([options, seed] {
    options->seed_given = seed->count() > 0;
    render_scene(*options, command_line_of(*options));
  });
}

}  // namespace frond
