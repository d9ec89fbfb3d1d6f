#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/kept_file.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "cli/render_report.h"
#include "cli/render_views.h"
#include "cli/strict_log.h"
#include "render/adaptive.h"
#include "render/checkpoint.h"
#include "render/error_tail.h"
#include "render/image_output.h"
#include "render/part_file.h"
#include "render/session.h"
#include "study/choose/choice_report.h"
#include "system/atomic_file.h"

namespace frond {
namespace {

using Clock = std::chrono::steady_clock;

/// In place of a render. People have it in the log.
void print_choice(const std::optional<choose::Choice>& choice, bool json) {
  if (!choice) fail({}, "--pilot: the scene leaves no leaf's model open: Material \"leaf\" does, or --swap \"*=leaf\"");
  if (json) fmt::print("{}\n", nlohmann::ordered_json::parse(choose::choice_json(*choice)).dump(2));
}

/// A render from its command line to its files.
class RenderCommand {
 public:
  /// `files` are read one after the other.
  RenderCommand(const RenderOptions& options, std::vector<std::filesystem::path> files)
      : options_(options),
        files_(std::move(files)),
        console_(options.quiet),
        log_(console_, options.reading.strict),
        session_(log_, {options.threads, cache_directory(options.cache, options.no_cache), options.plugins}),
        views_(options) {}

  /// The program's exit code.
  int run() {
    try {
      prepare();
    } catch (const InputError& error) {
      if (!options_.reading.strict) throw;
      Problems problems;  // what else would have been refused
      problems.add(error);
      problems.attempt([this] { log_.check(); });
      problems.check();
    }
    if (options_.pilot) return 0;
    if (names_) kept_.emplace(*names_, log_);
    RenderPart& part = part_.emplace(first_part());
    views_.begin(part.film, part.header.picture, output_ ? output_->path() : options_.part, console_);
    fill(part);
    const bool stopped = kept_ && kept_->was_stopped();
    if (kept_)  // a picture that is done is not lost with its checkpoint
      kept_->keep(!stopped, !output_, [&part](const auto& path) { write_part(path, part.header, part.film); });
    if (stopped) return kept_->say_how_to_go_on();
    finish(part);
    log_.check();
    return 0;
  }

 private:
  /// What can be refused is refused now, not after an hour.
  void prepare() {
    read();
    FilmSettings film = session_.film(description_);  // all of it: --crop and --pixels are told before --quick halves
    apply_overrides(overrides_of(options_), description_, session_.registry(), log_);
    film.crop = crop_of(options_, film, log_);
    if (options_.quick) film = halved(film);
    find_paths(film.filename);
    check_bands();
    PictureRequest request{.pixels = film.crop,
                           .is_piece = !options_.part.empty(),
                           .channels = options_.channels,
                           .adaptive = is_adaptive(),
                           .command = command_line_of(options_, files_.back())};
    // The whole picture decides, whatever part of it is rendered: parts of one picture go together.
    const auto chosen = choose::choose_for(session_, description_, uint64_t(options_.samples), request);
    if (chosen) choice_ = chosen->choice;
    if (options_.pilot) return print_choice(choice_, options_.json);
    if (choice_) load_start_ = Clock::now();  // its time is told apart
    scene_.emplace(session_.load(std::move(description_), request, chosen ? chosen->scene.get() : nullptr));
    load_seconds_ = std::chrono::duration<double>(Clock::now() - load_start_).count();
    range_ = {0, options_.samples > 0 ? uint64_t(options_.samples) : scene_->samples()};
    if (const auto range = range_of(options_)) range_ = *range;
    scene_->check_samples(range_.count());
    if (is_adaptive() && options_.samples > 0 && uint64_t(options_.samples) < kLeastAdaptive)
      fail({}, "--max-rms: {} samples per pixel at least tell how much noise there is, --spp allows {}", kLeastAdaptive,
           options_.samples);
    if (output_) output_->check(scene_->picture());
    views_.check(scene_->picture());
    log_.check();
  }

  /// Where something is wrong with the file, what else is wrong with the scene is told too.
  void read() {
    Problems problems;
    description_ = session_.read(files_, unsupported_of(options_.reading), problems);
    set_scene_options(options_, description_);
    if (!problems.empty() && !description_.files.empty()) problems.attempt([this] { session_.check(description_); });
    problems.check();
    for (const std::string& name : options_.of_pbrt) log_.warn({}, fmt::format("{} of pbrt has no effect here", name));
  }

  void find_paths(const std::string& scene_output) {
    if (!options_.part.empty()) {
      check_replaceable(options_.part);
      names_ = {options_.part, options_.part + ".checkpoint"};  // where there is a part of this name, it is finished
      return;
    }
    output_.emplace(options_.output.empty() ? scene_output : options_.output, options_.display);
    if (options_.checkpoint_seconds == 0 && !options_.resume) return;
    names_ = {output_->path() + ".part", output_->path() + ".part"};
    check_replaceable(names_->finished);
  }

  /// Before anything is chosen or loaded.
  void check_bands() const {
    if (output_) output_->check_channels(make_wavelengths(description_, session_.registry())->film_space());
  }

  bool is_adaptive() const { return options_.max_rms > 0; }

  /// What an earlier run has left, or nothing.
  RenderPart first_part() const {
    RenderPart fresh = scene_->empty_part();
    fresh.header.request = range_.end;
    const auto path = kept_ ? kept_->found(options_.resume) : std::nullopt;
    if (!path) return fresh;
    RenderPart part = read_part(*path);
    check_same_render(fresh, part, *path);
    part.header.request = range_.end;
    return part;
  }

  void check_same_render(const RenderPart& wanted, const RenderPart& found, const std::filesystem::path& path) const {
    const std::string difference =
        wanted.header.identity.difference(found.header.identity, "this command", "\"" + path.string() + "\"");
    if (!difference.empty()) fail({}, "--resume: this is another render. {}", difference);
    if (found.film.format().blocks != wanted.film.format().blocks)
      fail({}, "--resume: \"{}\" was made {} --max-rms", path.string(), is_adaptive() ? "without" : "with");
    if (found.film.settings().crop != wanted.film.settings().crop || found.film.sampled() != wanted.film.sampled())
      fail({}, "--resume: \"{}\" is of other pixels than this command asks for", path.string());
  }

  /// Renders what is missing.
  void fill(RenderPart& part) {
    ProgressLine line(options_.quiet);
    RenderControl control{.progress = &line};
    if (options_.time_limit_seconds > 0)
      control.deadline = start_ + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(options_.time_limit_seconds));
    if (!kept_) return render(part, control, nullptr);
    control.stop = kept_->stop();
    const double seconds = options_.checkpoint_seconds > 0 ? options_.checkpoint_seconds : KeptFile::kSeconds;
    Checkpointer checkpointer(kept_->checkpoint(), seconds, part, &line, log_);
    control.progress = &checkpointer;
    render(part, control, &checkpointer);
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

  void finish(const RenderPart& part) {
    views_.finish_preview();
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
    const ErrorTail tail = error_tail(part.film);
    if (tail.is_heavy())  // no fault of the scene's, so nothing to --strict
      console_.warn(
          {}, fmt::format("a thousandth of the pixels holds {:.0f} % of the noise: rare samples outweigh all others "
                          "there, and estimates of the noise are too small",
                          100 * tail.share));
    if (output_) output_->write(part.film, finished_picture(part));
    views_.finish_display(output_ && output_->rounds_to_halves(part.film));
    if (options_.quiet && !options_.json) return;
    print_report({.statistics = statistics_,
                  .load_seconds = load_seconds_,
                  .samples = samples,
                  .foliar_ratio = part.film.foliar_ratio(),
                  .error_tail = tail.share,
                  .choice = choice_,
                  .output = output_ ? output_->path() : names_->finished.string()},
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

  const RenderOptions& options_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point load_start_ = start_;
  std::vector<std::filesystem::path> files_;
  ConsoleLog console_;
  StrictLog log_;
  Session session_;
  SceneDescription description_;
  std::optional<ImageOutput> output_;     ///< empty: a part is asked for
  std::optional<KeptFile::Names> names_;  ///< empty: no part is kept
  std::optional<KeptFile> kept_;          ///< until all is written: signals come while the last part is
  std::optional<choose::Choice> choice_;
  std::optional<LoadedScene> scene_;
  SampleRange range_;
  std::optional<RenderPart> part_;
  RenderViews views_;  ///< of the part
  double load_seconds_ = 0;
  RenderStatistics statistics_;
};

}  // namespace

void add_render_command(CLI::App& app) {
  auto options = std::make_shared<RenderOptions>();
  auto* command = app.add_subcommand("render", "Render a pbrt-v4 scene file.");
  add_render_options(*command, *options);
  command->callback([options] {
    const auto scenes = scenes_of(options->scenes);
    if (scenes.size() > 1 && (!options->output.empty() || !options->part.empty()))
      fail({}, "{} scenes cannot all be written to {}: without it each goes where its Film says", scenes.size(),
           options->part.empty() ? options->output : options->part);
    for (const auto& files : scenes)
      if (const int code = RenderCommand(*options, files).run(); code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace frond
