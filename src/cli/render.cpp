#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <csignal>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/render_report.h"
#include "render/adaptive.h"
#include "render/checkpoint.h"
#include "render/image_output.h"
#include "render/part_file.h"
#include "render/session.h"
#include "scene/words.h"
#include "study/choose/choice_report.h"
#include "system/atomic_file.h"

namespace frond {
namespace {

using Clock = std::chrono::steady_clock;

struct RenderOptions {
  std::string scene, output, part, wavelengths, integrator, cache, range;
  std::vector<double> crop;
  std::vector<int> pixels;
  std::vector<std::string> swaps, plugins, channels;
  DisplayChoice display;
  int samples = 0, threads = 0;
  uint64_t seed = 0;
  double checkpoint_seconds = 0, time_limit_seconds = 0, max_rms = 0;
  bool seed_given = false, quick = false, json = false, quiet = false, no_cache = false, pilot = false, resume = false;
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
  overrides.cache_dir = cache_directory(options.cache, options.no_cache);  // of pilots; the session has its own
  overrides.quick = options.quick;
  return overrides;
}

/// Writes what is chosen into the description and the overrides. The whole picture decides, whatever part of it is
/// rendered: parts of one picture go together.
std::optional<choose::Choice> choose_models(const RenderOptions& options, Session& session,
                                            SceneDescription& description, SceneOverrides& overrides) {
  const choose::ChoiceTask subject{description, session.registry(), overrides, session.film(description, options.quick),
                                   uint64_t(options.samples)};
  auto chosen =
      choose::choose_models(subject, choose::standard_ladder(session.registry()), session.pool(), session.log());
  if (!chosen) return {};
  session.log().info(choose::choice_text(chosen->choice));
  if (const std::string warning = choose::choice_warning(chosen->choice); !warning.empty())
    session.log().warn({}, warning);
  description.materials = std::move(chosen->materials);
  overrides.wavelengths = chosen->wavelengths;
  return chosen->choice;
}

/// In place of a render. People have it in the log.
void print_choice(const std::optional<choose::Choice>& choice, bool json) {
  if (!choice) fail({}, "--pilot: the scene leaves no leaf's model open: Material \"leaf\" does, or --swap \"*=leaf\"");
  if (json) fmt::print("{}\n", nlohmann::ordered_json::parse(choose::choice_json(*choice)).dump(2));
}

/// What of the command decides the pixels, but for their number and that of their samples: threads, paths and what is
/// printed do not belong in a file's header.
std::string command_line_of(const RenderOptions& o) {
  std::string line = "frond render " + std::filesystem::path(o.scene).filename().string();
  if (o.seed_given) line += fmt::format(" --seed {}", o.seed);
  if (!o.wavelengths.empty()) line += " --wavelengths " + o.wavelengths;
  if (!o.integrator.empty()) line += " --integrator " + o.integrator;
  for (const std::string& plugin : o.plugins) line += " --plugin " + std::filesystem::path(plugin).filename().string();
  for (const std::string& swap : o.swaps) line += " --swap " + swap;
  if (!o.channels.empty()) line += fmt::format(" --channels {}", fmt::join(ChannelList(o.channels).names(), ","));
  if (o.quick) line += " --quick";
  return line;
}

/// "64:128"
SampleRange parse_range(const std::string& text) {
  SampleRange range;
  const char *begin = text.data(), *end = begin + text.size();
  const auto first = std::from_chars(begin, end, range.begin);
  const bool has_colon = first.ec == std::errc() && first.ptr != end && *first.ptr == ':';
  const auto last = std::from_chars(has_colon ? first.ptr + 1 : end, end, range.end);
  if (!has_colon || last.ec != std::errc() || last.ptr != end || range.empty() || range.end > 1u << 30)
    fail({}, "--samples takes FIRST:END, such as 64:128 for the 64 samples from number 64 on: \"{}\"", text);
  return range;
}

/// A render from its command line to its files.
class RenderCommand {
 public:
  explicit RenderCommand(const RenderOptions& options)
      : options_(options),
        log_(options.quiet),
        session_(log_, {options.threads, cache_directory(options.cache, options.no_cache), options.plugins}) {}

  /// The program's exit code.
  int run() {
    prepare();
    if (options_.pilot) return 0;
    if (keeps_part()) lock_.emplace(part_path_);
    RenderPart part = first_part();
    const int signal = fill(part);
    if (keeps_part()) keep(part, signal != 0);
    if (signal != 0) return say_how_to_go_on(signal);
    finish(part);
    return 0;
  }

 private:
  /// What can be refused is refused now, not after an hour.
  void prepare() {
    description_ = session_.read(options_.scene);
    apply_swaps(description_, swaps_of(options_), session_.registry(), log_);
    SceneOverrides overrides = overrides_of(options_);
    FilmSettings film = session_.film(description_, false);
    film.crop = crop_of(options_, film);
    if (options_.quick) film = halved(film);
    find_paths(film.filename);
    check_bands(overrides);
    PictureRequest request{.pixels = film.crop,
                           .channels = options_.channels,
                           .adaptive = is_adaptive(),
                           .command = command_line_of(options_)};
    choice_ = choose_models(options_, session_, description_, overrides);
    if (options_.pilot) return print_choice(choice_, options_.json);
    if (choice_) {
      load_start_ = Clock::now();  // its time is told apart
      request.attributes = choose::choice_attributes(*choice_);
      // What is chosen shall not change the space.
      if (!choice_->answers.front().is_leaf) request.color_space = "linear sRGB";
    }
    scene_.emplace(session_.load(std::move(description_), overrides, request));
    load_seconds_ = std::chrono::duration<double>(Clock::now() - load_start_).count();
    range_ = {0, options_.samples > 0 ? uint64_t(options_.samples) : scene_->samples()};
    if (!options_.range.empty()) range_ = parse_range(options_.range);
    scene_->check_samples(range_.count());
    if (is_adaptive() && options_.samples > 0 && uint64_t(options_.samples) < kLeastAdaptive)
      fail({}, "--max-rms: {} samples per pixel at least tell how much noise there is, --spp allows {}", kLeastAdaptive,
           options_.samples);
    if (output_) output_->check(scene_->picture());
  }

  void find_paths(const std::string& scene_output) {
    if (!options_.part.empty()) {
      check_replaceable(options_.part);
      part_path_ = checkpoint_path_ = options_.part;
      checkpoint_path_ += ".checkpoint";  // where there is a part of this name, it is finished
      return;
    }
    output_.emplace(options_.output.empty() ? scene_output : options_.output, options_.display);
    if (options_.checkpoint_seconds == 0 && !options_.resume) return;
    part_path_ = checkpoint_path_ = output_->path() + ".part";
    check_replaceable(part_path_);
  }

  /// Before anything is chosen or loaded.
  void check_bands(const SceneOverrides& overrides) const {
    const auto [text, where] = wavelength_choice(description_, overrides);
    if (output_)
      output_->check_channels(make_wavelengths(text, where, description_, session_.registry())->film_space());
  }

  bool is_adaptive() const { return options_.max_rms > 0; }
  bool keeps_part() const { return !part_path_.empty(); }

  /// What an earlier run has left, or nothing.
  RenderPart first_part() const {
    std::error_code error;
    RenderPart fresh = scene_->empty_part();
    fresh.header.request = range_.end;
    if (!keeps_part()) return fresh;
    const bool finished = std::filesystem::exists(part_path_, error);
    const std::filesystem::path& path = finished ? part_path_ : checkpoint_path_;
    if (!std::filesystem::exists(path, error)) return fresh;
    if (!options_.resume)
      fail({}, "\"{}\" is there already: --resume goes on from it; delete it to begin anew", path.string());
    RenderPart part = read_part(path);
    check_same_render(fresh, part, path);
    part.header.request = range_.end;
    return part;
  }

  void check_same_render(const RenderPart& wanted, const RenderPart& found, const std::filesystem::path& path) const {
    const std::string difference =
        wanted.header.identity.difference(found.header.identity, "this command", "\"" + path.string() + "\"");
    if (!difference.empty()) fail({}, "--resume: this is another render. {}", difference);
    if (found.film.format().blocks != wanted.film.format().blocks)
      fail({}, "--resume: \"{}\" was made {} --max-rms", path.string(), is_adaptive() ? "without" : "with");
    if (found.film.settings().crop != wanted.film.settings().crop)
      fail({}, "--resume: \"{}\" is of other pixels than this command asks for", path.string());
  }

  /// Renders what is missing. Returns the signal that ended it, or 0.
  int fill(RenderPart& part) {
    ProgressLine line(options_.quiet);
    RenderControl control{.progress = &line};
    if (options_.time_limit_seconds > 0)
      control.deadline = start_ + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(options_.time_limit_seconds));
    if (!keeps_part()) {
      render(part, control, nullptr);
      return 0;
    }
    interrupt_.emplace();
    control.stop = interrupt_->token();
    const double seconds = options_.checkpoint_seconds > 0 ? options_.checkpoint_seconds : kCheckpointSeconds;
    Checkpointer checkpointer(checkpoint_path_, seconds, part, &line, log_);
    control.progress = &checkpointer;
    render(part, control, &checkpointer);
    return interrupt_->signal();
  }

  void render(RenderPart& part, const RenderControl& control, Checkpointer* checkpointer) {
    if (!is_adaptive()) {
      statistics_ = session_.render(*scene_, range_, part, control);
      return;
    }
    NoiseRequest request{.max_rms = options_.max_rms};
    if (options_.samples > 0) request.most_samples = uint64_t(options_.samples);
    if (checkpointer) request.planned = [checkpointer](const PartHeader& header) { checkpointer->set_header(header); };
    statistics_ = session_.render_to(*scene_, request, part, control);
  }

  /// The last checkpoint, or what was asked for. Where the picture is done, it is not lost with its checkpoint.
  void keep(const RenderPart& part, bool stopped) const try {
    write_part(stopped ? checkpoint_path_ : part_path_, part.header, part.film);
    if (!stopped && checkpoint_path_ != part_path_) std::filesystem::remove(checkpoint_path_);
  } catch (const InputError& error) {
    if (stopped || !output_) throw;
    log_.warn({}, fmt::format("no checkpoint was written: {}", error.what()));
  }

  int say_how_to_go_on(int signal) const {
    log_.info(fmt::format("stopped; what was rendered is in {}: the same command with --resume goes on from there",
                          checkpoint_path_.string()));
    return 128 + signal;
  }

  void finish(const RenderPart& part) const {
    const SampleCount samples = sample_count(part.film);
    if (output_ && samples.most == 0) fail({}, "--time-limit: the time was over before anything was rendered");
    if (const uint64_t count = part.film.not_finite(); count > 0)
      log_.warn(
          {},
          fmt::format(
              "{} samples were too bright for the film, or no numbers at all, and count as its brightest or as black",
              count));
    if (is_adaptive())
      say_noise(part.film);
    else if (samples.least < range_.count())
      log_.warn({}, fmt::format("the time was over: pixels have {} to {} samples, not {}", samples.least, samples.most,
                                range_.count()));
    if (output_) output_->write(part.film, finished_picture(part));
    if (options_.quiet && !options_.json) return;
    print_report({.statistics = statistics_,
                  .load_seconds = load_seconds_,
                  .samples = samples,
                  .foliar_ratio = part.film.foliar_ratio(),
                  .choice = choice_,
                  .output = output_ ? output_->path() : part_path_.string()},
                 options_.json);
  }

  void say_noise(const Film& film) const {
    const NoiseEstimate noise = picture_noise(film, noise_z());
    if (noise.upper_rms() <= options_.max_rms)
      log_.info(fmt::format("noise RMS {:.5f}, {:.5f} at most ({:.0f} %)", noise.rms(), noise.upper_rms(),
                            100 * kNoiseConfidence));
    else
      log_.warn({}, fmt::format("noise RMS {:.5f}, {:.5f} at most: more than the {:g} asked for", noise.rms(),
                                noise.upper_rms(), options_.max_rms));
  }

  static constexpr double kCheckpointSeconds = 60;

  const RenderOptions& options_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point load_start_ = start_;
  ConsoleLog log_;
  Session session_;
  SceneDescription description_;
  std::optional<ImageOutput> output_;      ///< empty: a part is asked for
  std::filesystem::path part_path_;        ///< empty: no part is kept
  std::filesystem::path checkpoint_path_;  ///< what is not finished
  std::optional<PartLock> lock_;
  std::optional<Interrupt> interrupt_;  ///< until all is written: signals come while the last part is
  std::optional<choose::Choice> choice_;
  std::optional<LoadedScene> scene_;
  SampleRange range_;
  double load_seconds_ = 0;
  RenderStatistics statistics_;
};

std::string channels_doc() {
  std::string doc = "What camera rays meet first, beside the image's colours:";
  for (const ChannelInfo& channel : all_channels())
    doc += fmt::format("{} {} ({})", doc.ends_with(':') ? "" : ",", channel.name, channel.doc);
  return doc + '.';
}

}  // namespace

void add_render_command(CLI::App& app) {
  auto options = std::make_shared<RenderOptions>();
  RenderOptions& o = *options;
  auto* command = app.add_subcommand("render", "Render a pbrt-v4 scene file.");
  command->add_option("scene", o.scene, "Scene file.")->required();
  auto* output = command->add_option("-o,--output", o.output,
                                     "Image: .exr (linear), .png or .jpg (through the display transform).");
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
  auto* part = command->add_option(
      "--part", o.part, "Write the sums, which frond merge adds to those of other parts, instead of an image.");
  part->excludes(output);
  auto* range = command->add_option("--samples", o.range,
                                    "FIRST:END of the samples to render, as 64:128; from 0 to --spp by default.");
  command
      ->add_option(
          "--checkpoint", o.checkpoint_seconds,
          "Every so many seconds, and when stopped by SIGINT or SIGTERM, keep what is done in OUTPUT.part, or in "
          "FILE.checkpoint where --part asks for FILE.")
      ->check(is_positive);
  command->add_flag("--resume", o.resume,
                    "Go on from OUTPUT.part, or --part's file, where there is one; keeps one too.");
  command->add_option("--time-limit", o.time_limit_seconds, "End after so many seconds, with what there is then.")
      ->check(is_positive);
  command
      ->add_option(
          "--max-rms", o.max_rms,
          "Render until the noise of the picture's linear colours is below this, with more samples where there "
          "is more; --spp is then the most that a pixel gets.")
      ->check(is_positive)
      ->excludes(range);
  command->add_option("--channels", o.channels, channels_doc())->delimiter(',');
  command->callback([options, seed] {
    options->seed_given = seed->count() > 0;
    const int code = RenderCommand(*options).run();
    if (code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace frond
