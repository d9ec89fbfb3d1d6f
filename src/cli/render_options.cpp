#include "cli/render_options.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <charconv>

#include "cli/common_options.h"
#include "image/tev_packets.h"
#include "render/channels.h"

namespace frond {
namespace {

std::string channels_doc() {
  std::string doc = "What camera rays meet first, beside the image's colours:";
  for (const ChannelInfo& channel : all_channels())
    doc += fmt::format("{} {} ({})", doc.ends_with(':') ? "" : ",", channel.name, channel.doc);
  return doc + '.';
}

/// "leaf=abm" or "leaf=abm,mode=analog".
MaterialSwap parse_swap(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    fail({}, "--swap takes MATERIAL=PLUGIN[,parameter=value...], \"{}\" was given", text);
  const Location where{std::make_shared<const std::string>("--swap " + text)};
  return {text.substr(0, equals), parse_plugin_text(text.substr(equals + 1), where), where};
}

RenderOptions with_bounds_of_pixel(RenderOptions o) {
  o.pixels = {o.pixel[0], o.pixel[0] + 1, o.pixel[1], o.pixel[1] + 1};
  o.pixel.clear();
  return o;
}

/// Options of pbrt that change nothing here.
void add_idle_options(CLI::App& command, RenderOptions& o) {
  const auto add = [&](const char* name, const char* doc) {
    return command.add_flag_callback(
        name, [&o, name] { o.of_pbrt.emplace_back(name); }, doc);
  };
  add("--gpu", "pbrt's: warns. The CPU renders.");
  add("--wavefront", "pbrt's: warns.");
  add("--write-partial-images", "pbrt's: warns; --checkpoint keeps what is done.");
  add("--pixelstats", "pbrt's: warns.");
  add("--force-diffuse", "pbrt's: warns; --swap changes materials.");
  add("--log-utilization", "pbrt's: warns.");
  command.add_flag_callback(
      "--stats", [] {}, "pbrt's: statistics are printed in any case.");
  const auto add_with_value = [&](const char* name, const char* doc) {
    command.add_option_function<std::string>(
        name, [&o, name](const std::string&) { o.of_pbrt.emplace_back(name); }, doc);
  };
  add_with_value("--gpu-device", "pbrt's: warns.");
  add_with_value("--log-level", "pbrt's: warns.");
  add_with_value("--log-file", "pbrt's: warns.");
  add_with_value("--displacement-edge-scale", "pbrt's: warns.");
  command
      .add_option_function<std::string>(
          "--render-coord-sys", [](const std::string&) {}, "pbrt's: changes no picture.")
      ->check(CLI::IsMember({"camera", "cameraworld", "world"}));
}

/// Options of pbrt that ask for something else than a picture.
void add_refused_options(CLI::App& command) {
  const auto refuse = [&](const char* name, const char* instead) {
    command.add_option_function<std::string>(
        name, [name, instead](const std::string&) { fail({}, "{}: {}", name, instead); },
        std::string("pbrt's, refused: ") + instead);
  };
  const auto refuse_flag = [&](const char* name, const char* instead) {
    command.add_flag_callback(
        name, [name, instead] { fail({}, "{}: {}", name, instead); }, std::string("pbrt's, refused: ") + instead);
  };
  refuse("--mse-reference-image", "frond difference compares pictures");
  refuse("--mse-reference-out", "frond difference compares pictures");
  refuse("--debugstart", "--pixels and --samples find one path again");
  refuse("--pixelmaterial", "--channels material writes what each pixel shows");
  refuse_flag("--interactive", "frond has no window; --display-server shows the picture in a viewer's");
  refuse_flag("--fullscreen", "frond has no window");
  refuse_flag("--disable-image-textures", "frond has nothing like it");
  refuse_flag("--format", "pbrt-v4 itself rewrites scene files");
  refuse_flag("--toply", "pbrt-v4 itself rewrites scene files");
  refuse_flag("--upgrade", "pbrt-v4 itself upgrades files of pbrt-v3");
}

}  // namespace

void set_scene_options(const RenderOptions& o, SceneDescription& description) {
  const auto set = [&description](bool is_asked_for, const char* name) {
    if (is_asked_for) set_param(description.options, {"bool", name, {}, {}, std::vector<bool>{true}});
  };
  set(o.no_pixel_jitter, "disablepixeljitter");
  set(o.no_texture_filtering, "disabletexturefiltering");
  set(o.no_wavelength_jitter, "disablewavelengthjitter");
}

std::vector<MaterialSwap> swaps_of(const std::vector<std::string>& swaps) {
  std::vector<MaterialSwap> result;
  for (const std::string& swap : swaps) result.push_back(parse_swap(swap));
  return result;
}

Crop crop_of(const RenderOptions& o, const FilmSettings& film, const Log& log) {
  if (!o.pixel.empty()) return crop_of(with_bounds_of_pixel(o), film, log);
  if (o.crop.empty() && o.pixels.empty()) return film.crop;
  const auto ordered = [&log](auto bounds) {
    if (put_in_order(bounds))
      log.warn({}, fmt::format("the crop's ends are the wrong way round: taken for {}", fmt::join(bounds, ",")));
    return bounds;
  };
  const Crop crop = o.crop.empty() ? crop_of_pixels(ordered(o.pixels), film.width, film.height)
                                   : crop_of_fractions(ordered(o.crop), film.width, film.height);
  if (crop.width() <= 0 || crop.height() <= 0)
    fail({}, "{} holds no pixel of the {} x {} film: it takes x0,x1,y0,y1",
         o.crop.empty() ? fmt::format("--pixels {}", fmt::join(o.pixels, ","))
                        : fmt::format("--crop {}", fmt::join(o.crop, ",")),
         film.width, film.height);
  return crop;
}

SceneOverrides overrides_of(const RenderOptions& options) {
  SceneOverrides overrides;
  overrides.swaps = swaps_of(options.swaps);
  overrides.wavelengths = options.wavelengths;
  if (!options.integrator.empty()) overrides.integrator = parse_plugin_text(options.integrator, {});
  if (!options.filter.empty()) overrides.filter = parse_plugin_text(options.filter, {});
  overrides.seed = options.seed;
  overrides.quick = options.quick;
  return overrides;
}

std::string command_line_of(const RenderOptions& o, const std::filesystem::path& scene) {
  std::string line = "frond render " + scene.filename().string();
  if (o.seed) line += fmt::format(" --seed {}", *o.seed);
  if (!o.wavelengths.empty()) line += " --wavelengths " + o.wavelengths;
  if (!o.integrator.empty()) line += " --integrator " + o.integrator;
  if (!o.filter.empty()) line += " --filter " + o.filter;
  for (const std::string& plugin : o.plugins) line += " --plugin " + std::filesystem::path(plugin).filename().string();
  for (const std::string& swap : o.swaps) line += " --swap " + swap;
  if (!o.channels.empty()) line += fmt::format(" --channels {}", fmt::join(ChannelList(o.channels).names(), ","));
  if (o.quick) line += " --quick";
  if (o.no_pixel_jitter) line += " --disable-pixel-jitter";
  if (o.no_texture_filtering) line += " --disable-texture-filtering";
  if (o.no_wavelength_jitter) line += " --disable-wavelength-jitter";
  if (!o.reading.ignore_unsupported.empty()) line += " --ignore-unsupported=" + o.reading.ignore_unsupported;
  return line;
}

std::optional<SampleRange> range_of(const RenderOptions& options) {
  if (options.range.empty()) return {};
  const std::string& text = options.range;
  SampleRange range;
  const char *begin = text.data(), *end = begin + text.size();
  const auto first = std::from_chars(begin, end, range.begin);
  const bool has_colon = first.ec == std::errc() && first.ptr != end && *first.ptr == ':';
  const auto last = std::from_chars(has_colon ? first.ptr + 1 : end, end, range.end);
  if (!has_colon || last.ec != std::errc() || last.ptr != end || range.empty() || range.end > 1u << 30)
    fail({}, "--samples takes FIRST:END, such as 64:128 for the 64 samples from number 64 on: \"{}\"", text);
  return range;
}

void add_render_options(CLI::App& command, RenderOptions& o) {
  command.add_option("scene", o.scenes, "Scene file; of several, each is rendered, after pieces without WorldBegin.")
      ->type_name("SCENE")
      ->required();
  auto* output = command
                     .add_option("-o,--output,--outfile", o.output,
                                 "Image: .exr (linear), .png or .jpg (through the display transform).")
                     ->type_name("FILE");
  add_count_option(command, "--spp", o.samples, 1 << 30, "Samples per pixel, in place of the scene's.");
  command.add_option("--threads,--nthreads", o.threads, "Threads; all by default. The image does not depend on it.")
      ->check(CLI::Range(1, 1024));
  command.add_option("--seed", o.seed, "Seed of all random numbers.")->check(is_seed);
  auto* crop = command.add_option("--crop,--cropwindow", o.crop,
                                  "x0,x1,y0,y1 of what to render, as fractions of the film; ends are rounded up.");
  crop->delimiter(',')->expected(4)->check(is_within({0, 1}));
  auto* pixels = command.add_option("--pixels,--pixelbounds", o.pixels,
                                    "x0,x1,y0,y1 of what to render, in pixels; x1 and y1 are not in it.");
  pixels->delimiter(',')->expected(4)->check(is_pixel)->excludes(crop);
  command.add_option("--pixel", o.pixel, "x,y of the one pixel to render.")
      ->delimiter(',')
      ->expected(2)
      ->check(is_pixel)
      ->excludes(crop)
      ->excludes(pixels);
  command
      .add_option("--wavelengths", o.wavelengths,
                  "hero (also hero,lambdamin=400,lambdamax=700), meyer, smpte for the paper's three, or "
                  "bands,wavelengths=450,550,850 (also bands,lambdamin=400,lambdamax=1000,step=10).")
      ->type_name("WAVELENGTHS");
  command
      .add_option("--integrator", o.integrator,
                  "PLUGIN[,parameter=value...]; one of the scene's kind keeps the scene's other parameters.")
      ->type_name("INTEGRATOR");
  command
      .add_option("--filter", o.filter,
                  "Pixel filter: PLUGIN[,parameter=value...]; one of the scene's kind keeps the scene's other "
                  "parameters. gaussian,reconstruction=importance: pixels share no samples.")
      ->type_name("FILTER");
  command
      .add_option("--swap", o.swaps,
                  "MATERIAL=PLUGIN[,parameter=value...]: another model; \"*=PLUGIN\": for every leaf.")
      ->type_name("SWAP")
      ->allow_extra_args(false);
  add_plugin_option(command, o.plugins);
  const auto set_display = [&o](const std::string& name) {
    if (name == "tev")
      o.display_server = kTevAddress;
    else
      o.display.display = name;
  };
  command.add_option_function<std::string>(
      "--display", set_display,
      "Display of PNG and JPEG output; sRGB by default. tev: short for --display-server 127.0.0.1:14158.");
  command.add_option("--view", o.display.view, "View of that display.");
  command
      .add_option("--display-server", o.display_server,
                  "HOST:PORT where the image viewer tev listens: it shows the picture while it is rendered.")
      ->type_name("ADDRESS");
  command.add_flag("--preview", o.preview, "Show the picture in the terminal while it is rendered, and at the end.");
  command.add_option("--cache", o.cache, "Folder for tables computed at load; ~/.cache/frond by default.")
      ->type_name("FOLDER");
  command.add_flag("--no-cache", o.no_cache, "Keep no tables on disk.");
  command.add_flag("--quick", o.quick, "A first look: half the resolution, a sixteenth of the samples.");
  command.add_flag("--pilot", o.pilot, "Choose the models of open leaves, say which, and render nothing.");
  command.add_flag("--json", o.json, "Print the statistics as JSON on standard output.");
  command.add_flag("-q,--quiet", o.quiet, "Print nothing but errors.");
  auto* part = command
                   .add_option("--part", o.part,
                               "Write the sums, which frond merge adds to those of other parts, instead of an image.")
                   ->type_name("FILE");
  part->excludes(output);
  auto* range = command.add_option("--samples", o.range,
                                   "FIRST:END of the samples to render, as 64:128; from 0 to --spp by default.");
  command
      .add_option(
          "--checkpoint", o.checkpoint_seconds,
          "Every so many seconds, and when stopped by SIGINT or SIGTERM, keep what is done in OUTPUT.part, or in "
          "FILE.checkpoint where --part asks for FILE.")
      ->check(is_positive);
  command.add_flag("--resume", o.resume,
                   "Go on from OUTPUT.part, or --part's file, where there is one; keeps one too.");
  command.add_option("--time-limit", o.time_limit_seconds, "End after so many seconds, with what there is then.")
      ->check(is_positive);
  command
      .add_option("--max-rms", o.max_rms,
                  "Render until the noise of the picture's linear colours is below this, with more samples where there "
                  "is more; --spp is then the most that a pixel gets.")
      ->check(is_positive)
      ->excludes(range);
  command.add_option("--channels", o.channels, channels_doc())->type_name("CHANNELS")->delimiter(',');
  add_reading_options(command, o.reading);
  command.add_flag("--disable-pixel-jitter", o.no_pixel_jitter, "All samples at the pixels' centres and the lens's.");
  command.add_flag("--disable-texture-filtering", o.no_texture_filtering, "Read textures at points.");
  command.add_flag("--disable-wavelength-jitter", o.no_wavelength_jitter, "All samples see the same wavelengths.");
  add_idle_options(command, o);
  add_refused_options(command);
}

}  // namespace frond
