#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "core/messages/counted.h"
#include "image/image_file.h"
#include "jobs/record/common_params.h"
#include "jobs/support/display_params.h"
#include "jobs/support/render_task.h"
#include "jobs/support/render_views.h"
#include "jobs/support/resume_file.h"
#include "jobs/support/time_limit.h"
#include "render/checkpoint.h"
#include "render/film/adaptive.h"
#include "render/film/error_tail.h"
#include "render/parts/part_file.h"
#include "study/choose/choice_report.h"
#include "system/atomic_file.h"
#include "system/file_uses.h"

namespace frond {

// `frond render`: images, parts of images, and checkpoints.

namespace {

using enum ArgumentKind;
using Clock = std::chrono::steady_clock;

constexpr JobParam kRenderParams[] = {
    JobParam(
        "scene", texts,
        "Scene file (pbrt-v4 format). Several files are read as one scene, up to the first with WorldBegin; the "
        "next file begins another.",
        {.type = "SCENE", .path = PathUse::read, .scene = true, .decides = true, .positional = true, .required = true}),
    JobParam(
        "output", text,
        "Image: .exr (linear), .png or .jpg (through the display transform). By default the file named by the scene's "
        "film.",
        {.type = "FILE", .aliases = "o,outfile", .path = PathUse::write, .excludes = "part"}),
    JobParam("spp", count, "Number of samples per pixel; by default the scene's.", {.range = {1, 1 << 30}}),
    JobParam(
        "wavelengths", text,
        "Wavelength strategy: hero (hero,lambdamin=400,lambdamax=700), meyer, smpte (the paper's three), or bands in "
        "nm: 450,550,850 or 400:1000:10.",
        {.type = "WAVELENGTHS", .decides = true}),
    kSwapParam,
    kSeedParam,
    JobParam(
        "crop", numbers, "Crop as fractions of the film; ends are rounded up.",
        {.type = "X0,X1,Y0,Y1", .range = {0, 1}, .aliases = "cropwindow", .values = 4, .excludes = "pixels,pixel"}),
    JobParam("pixels", numbers, "Crop in pixels; x1 and y1 are excluded.",
             {.type = "X0,X1,Y0,Y1",
              .range = {0, 1 << 30},
              .aliases = "pixelbounds",
              .values = 4,
              .whole = true,
              .excludes = "pixel"}),
    JobParam("pixel", numbers, "Single pixel to render.",
             {.type = "X,Y", .range = {0, 1 << 30}, .values = 2, .whole = true}),
    kIntegratorParam,
    JobParam("filter", text,
             "PLUGIN[,parameter=value...]: pixel filter; parameters that are not given keep the scene's values if the "
             "type is the scene's. "
             "gaussian,reconstruction=importance: each sample counts in one pixel only.",
             {.type = "FILTER", .decides = true}),
    JobParam("channels", text,
             "Additional channels with data of the first surface that camera rays hit; names separated by commas "
             "(docs/scene_format.md).",
             {.type = "CHANNELS", .decides = true}),
    JobParam(
        "for-denoiser", flag,
        "Render for a denoiser: pixels without common samples (the filter's reconstruction becomes importance), and "
        "the channels albedo and normal (docs/rendering.md).",
        {.decides = true}),
    JobParam(
        "max-rms", real,
        "Stop when the RMS noise of the image's linear colours is below this: a number is in film units (1: white), "
        "2% is relative to each colour's mean over the image. Pixels with more noise get more samples, up to "
        "--spp.",
        {.range = kAboveZero, .relative = true, .excludes = "samples"}),
    kTimeLimitParam,
    JobParam("quick", flag, "Preview: half the resolution, a sixteenth of the samples.", {.decides = true}),
    JobParam("pilot", flag, "Select the models of open leaves and report them; render nothing."),
    JobParam("display", text,
             "OpenColorIO display of PNG and JPEG output; sRGB by default. tev: the same as --display-server "
             "127.0.0.1:14158."),
    JobParam("view", text, "View of the display."),
    kExposureParam,
    kWhiteParam,
    JobParam("color-space", text,
             "Colour space of R, G and B in an EXR file if the scene names none, such as linear sRGB.",
             {.decides = true}),
    JobParam("display-server", text, "Show the image in the viewer tev while it is rendered.", {.type = "HOST:PORT"}),
    JobParam("preview", flag, "Show the image in the terminal while it is rendered, and at the end."),
    JobParam("part", text, "Write a part, to be combined with frond merge, instead of an image.",
             {.type = "FILE", .path = PathUse::write}),
    JobParam("samples", text, "Range of samples to render, without END, as in 64:128; by default from 0 to --spp.",
             {.type = "FIRST:END"}),
    JobParam("checkpoint", real,
             "Save the partial result at this interval, and when stopped by SIGINT, SIGTERM or SIGHUP: in OUTPUT.part, "
             "or in "
             "FILE.checkpoint if --part writes FILE.",
             {.unit = "s", .range = kAboveZero}),
    JobParam("resume", flag, "Resume from OUTPUT.part, or --part's file, if it exists; also save checkpoints."),
    JobParam("disable-pixel-jitter", flag, "Sample the centres of pixels and lens.", {.decides = true}),
    JobParam("disable-texture-filtering", flag, "Point-sample textures.", {.decides = true}),
    JobParam("disable-wavelength-jitter", flag, "Use the same wavelengths for all samples.", {.decides = true}),
    kIgnoreUnsupportedParam,
    kStrictParam,
    kJsonParam,
};

/// Counts by path depth, without trailing zeros.
std::vector<uint64_t> counts(std::span<const uint64_t> by_depth) {
  while (!by_depth.empty() && by_depth.back() == 0) by_depth = by_depth.first(by_depth.size() - 1);
  return {by_depth.begin(), by_depth.end()};
}

/// Returns 0 without paths, for a render that was complete already.
double per_path(double value, const RenderStatistics& s) { return s.paths > 0 ? value / double(s.paths) : 0; }

/// One render, from its scene to its files.
class SceneRender {
 public:
  SceneRender(const JobRun& run, const SceneInput& input) : run_(run), input_(input), task_(run), views_(run.args) {}

  /// Appends the render's statistics to the table of the result, and to `json`.
  void render(Result& result, std::vector<nlohmann::ordered_json>& json) {
    try {
      within_time_limit(
          run_, limit(), [this] { prepare(); }, [this] { return where(); });
    } catch (const InputError& error) {
      if (!run_.args.flag("strict")) throw;
      Problems problems;  // warnings so far are errors too
      problems.add(error);
      problems.attempt([this] { run_.context.log().check(); });
      problems.check();
    }
    if (run_.args.flag("pilot")) return report_choice(result, json);
    if (names_) resume_file_.emplace(*names_, run_.control.stop, run_.log());
    RenderPart part = first_part();
    views_.begin(part.film, part.header.image, output_ ? output_->path() : run_.args.text("part"),
                 run_.context.log().target());
    render_missing_samples(part);
    const UnstoppableScope whole;  // a stop that comes now does not end the writing
    result.stopped = run_.control.stop.stop_requested();
    if (resume_file_)  // a complete image is written even if its checkpoint fails
      resume_file_->keep(!result.stopped, !output_,
                         [&part](const auto& path) { write_part(path, part.header, part.film); });
    if (result.stopped && resume_file_) return resume_file_->report_stop();
    if (result.stopped) return;
    finish(part, result);
    json.push_back(json_of(result));
  }

 private:
  /// The front end's control, with the time limit.
  RenderControl limit() const { return run_.control_until(run_.args.real("time-limit"), start_); }
  Location where() const { return task_.where().file ? task_.where() : scene_file(run_.args); }

  /// Detects errors before the render: reads and builds the scene, checks outputs.
  void prepare() {
    task_.read(input_);
    find_paths();
    // A pilot that takes longer than this part of the time limit ends with the exact models: an image with noise is
    // worth more than a better choice of models without time to use them.
    constexpr double kPilotPart = 0.25;
    task_.choose(output_ ? &*output_ : nullptr,
                 run_.control_until(kPilotPart * run_.args.real("time-limit"), start_).deadline);
    if (run_.args.flag("pilot")) return;
    if (task_.choice()) load_start_ = Clock::now();  // the time of the selection is reported separately
    task_.load(output_ ? &*output_ : nullptr);
    load_seconds_ = std::chrono::duration<double>(Clock::now() - load_start_).count();
    views_.check(task_.scene().image_format());
    run_.context.log().check();
  }

  /// Determines the files: a part, or an image with its partial result beside it.
  void find_paths() {
    const Arguments& args = run_.args;
    if (args.given("part")) {
      const std::string part = args.text("part");
      // A part is linear.
      for (const char* name : {"exposure", "white-balance", "display", "view"})
        if (args.given(name) && args.text(name) != "tev")
          fail({}, "{} is for an image: frond merge, which makes one of parts, has it", args.spelled(name));
      names_ = {part, part + ".checkpoint"};  // a part of this name is complete
      return;
    }
    if (!args.given("output")) film_output_.emplace("the scene's Film", task_.film_file(), task_.film_where());
    output_.emplace(args.given("output") ? args.text("output") : task_.film_file(), display_of(args));
    for (const char* name : {"channels", "color-space"})
      if (args.given(name) && !is_exr(output_->path()))
        fail({}, "{} is for .exr: {} holds the colours of the display alone", args.spelled(name), output_->path());
    if (!args.given("checkpoint") && !args.flag("resume")) return;
    names_ = {output_->path() + ".part", output_->path() + ".part"};
    check_replaceable(names_->finished);
  }

  /// Adds the selected models to the result, for --pilot.
  void report_choice(Result& result, std::vector<nlohmann::ordered_json>& json) const {
    const auto& choice = task_.choice();
    if (!choice)
      fail({}, "{}: the scene leaves no leaf's model open: Material \"leaf\" does, or {} \"*=leaf\"",
           run_.args.spelled("pilot"), run_.args.spelled("swap"));
    result.facts.push_back({"choice", choose::choice_json(*choice)});
    json.push_back(nlohmann::ordered_json::parse(choose::choice_json(*choice)));
  }

  /// Returns an earlier run's partial result, or an empty part. Throws InputError if that result is of another render.
  RenderPart first_part() const {
    RenderPart fresh = task_.empty_part();
    const auto path = resume_file_ ? resume_file_->found(run_.args.flag("resume")) : std::nullopt;
    if (!path) return fresh;
    RenderPart part = read_part(*path);
    check_same_render(fresh, part, *path);
    part.header.request = fresh.header.request;
    return part;
  }

  /// Throws InputError, which names the difference, unless the found part belongs to the same render.
  void check_same_render(const RenderPart& wanted, const RenderPart& found, const std::filesystem::path& path) const {
    const std::string resume = run_.args.spelled("resume");
    const std::string difference =
        wanted.header.identity.difference(found.header.identity, "this command", "\"" + path.string() + "\"");
    if (!difference.empty()) fail({}, "{}: this is another render. {}", resume, difference);
    if (found.film.format().halves != wanted.film.format().halves)
      fail({}, "{}: \"{}\" was made {} {}", resume, path.string(), task_.is_adaptive() ? "without" : "with",
           run_.args.spelled("max-rms"));
    if (found.film.settings().crop != wanted.film.settings().crop || found.film.sampled() != wanted.film.sampled())
      fail({}, "{}: \"{}\" has other pixels than this command requests", resume, path.string());
  }

  /// Renders the samples that the part lacks.
  void render_missing_samples(RenderPart& part) {
    RenderControl control = limit();
    std::optional<Checkpointer> checkpointer;
    if (resume_file_) {
      checkpointer.emplace(resume_file_->checkpoint(), checkpoint_seconds(run_.args), part, control.progress,
                           run_.log());
      control.progress = &*checkpointer;
    }
    statistics_ = task_.render(part, control, [&checkpointer](const auto& change, const PartHeader& header) {
      if (checkpointer)
        checkpointer->change_part(change, header);
      else
        change();
    });
  }

  /// Reports noise, writes the image, and reports statistics.
  void finish(const RenderPart& part, Result& result) {
    views_.finish_preview();
    const SampleCount samples = sample_count(part.film);
    if (output_ && samples.most == 0)
      fail(where(), "{}: the time limit ended before any sample was rendered", run_.args.spelled("time-limit"));
    const Log& log = run_.log();
    uint64_t lost = part.film.not_finite();  // samples of faulty plug-ins have been reported by name
    for (const auto& [fault, count] : statistics_.faults) lost -= std::min(lost, count);
    if (lost > 0)
      log.warn({}, fmt::format("{} as its largest value or as black",
                               counted(lost, "sample was too bright for the film or not finite: it counts",
                                       "samples were too bright for the film or not finite: they count")));
    // Adaptive renders report noise; others report missing samples.
    if (task_.is_adaptive())
      report_noise(part, samples);
    else if (samples.least < task_.samples().count())
      log.warn({}, fmt::format("the time limit ended: pixels have {} to {} samples, not {}", samples.least,
                               samples.most, task_.samples().count()));
    const ErrorTail tail = error_tail(part.film);
    if (tail.is_heavy())  // not an error in strict mode: the scene is correct
      run_.context.log().target().warn(
          {}, fmt::format("0.1 % of the pixels contain {:.0f} % of the noise: rare samples dominate "
                          "there, and noise is underestimated",
                          100 * tail.share));
    if (output_) {
      if (const std::string text = unsampled_text(part.film); !text.empty()) log.warn({}, text);
      const auto& exposure = output_->display().exposure;
      const auto applied = output_->write(part.film, finished_format(part));
      report_exposure(run_, exposure && exposure->is_auto, applied, output_->path());
    }
    views_.finish_display(output_ && output_->rounds_to_halves(part.film));
    report(part.film, samples, tail.share, result);
  }

  /// Logs the image's noise; warns if it exceeds --max-rms.
  void report_noise(const RenderPart& part, const SampleCount& samples) const {
    if (samples.least == 0) {
      run_.log().warn({}, "the render ended before all pixels had samples: their noise is unknown");
      return;
    }
    // In the unit of the request: per cent of the means, or film units.
    const bool is_relative = run_.args.is_relative("max-rms");
    const NoiseEstimate noise =
        image_noise(part.film, noise_z(part.header.round + 1), noise_unit(part.film, is_relative));
    const double max_rms = run_.args.real("max-rms");
    const auto text = [is_relative](double rms) {
      return is_relative ? fmt::format("{:.3g} % of the mean", 100 * rms) : fmt::format("{:.5f}", rms);
    };
    if (noise.upper_rms() <= max_rms)
      run_.log().info(fmt::format("noise RMS {}, {} at most ({:.0f} % confidence)", text(noise.rms()),
                                  text(noise.upper_rms()), 100 * kNoiseConfidence));
    else
      run_.log().warn({}, fmt::format("noise RMS {}, {} at most: more than the requested {}", text(noise.rms()),
                                      text(noise.upper_rms()), run_.args.words("max-rms").back()));
  }

  /// Adds the statistics to the table, and logs them.
  void report(const Film& film, const SampleCount& samples, double error_tail, Result& result) const {
    const RenderStatistics& s = statistics_;
    const std::string output = output_ ? output_->path() : names_->finished.string();
    const double us_per_path = per_path(s.cpu_seconds, s) * 1e6, rays_per_path = per_path(double(s.rays), s);
    Table& table = result.tables[0];
    table.add("output", output);
    for (const auto& [name, value] : {std::pair{"samples_per_pixel", double(samples.most)},
                                      {"least_samples_per_pixel", double(samples.least)},
                                      {"load_seconds", load_seconds_},
                                      {"wall_seconds", s.wall_seconds},
                                      {"cpu_seconds", s.cpu_seconds},
                                      {"paths", double(s.paths)},
                                      {"rays", double(s.rays)},
                                      {"cpu_us_per_path", us_per_path},
                                      {"rays_per_path", rays_per_path},
                                      {"foliar_ratio", film.foliar_ratio()},
                                      {"variance_in_worst_thousandth", error_tail}})
      table.add(name, value);
    const std::string count = samples.least == samples.most
                                  ? counted(samples.most, "sample")
                                  : fmt::format("{} to {} samples", samples.least, samples.most);
    run_.log().info(
        fmt::format("{}: {} per pixel in {:.2f} s ({:.2f} s of CPU, {:.3f} us and {:.2f} rays per path), "
                    "loaded in {:.2f} s",
                    output, count, s.wall_seconds, s.cpu_seconds, us_per_path, rays_per_path, load_seconds_));
    run_.log().info(fmt::format("foliar ratio (camera samples that hit a leaf): {:.2f} %", 100 * film.foliar_ratio()));
  }

  /// Returns the last row of the table as a JSON object, with path counts by depth.
  nlohmann::ordered_json json_of(const Result& result) const {
    nlohmann::ordered_json json;
    const Table& table = result.tables[0];
    for (const Column& c : table.columns) {
      if (!c.is_number())
        json[c.name] = std::get<1>(c.values).back();
      else if (const double v = std::get<0>(c.values).back(); v == double(uint64_t(v)))
        json[c.name] = uint64_t(v);
      else
        json[c.name] = v;
    }
    json["paths_escaped_by_depth"] = counts(statistics_.ends.escaped);
    json["paths_absorbed_by_depth"] = counts(statistics_.ends.absorbed);
    if (task_.choice()) json["choice"] = nlohmann::ordered_json::parse(choose::choice_json(*task_.choice()));
    return json;
  }

  const JobRun& run_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point load_start_ = start_;
  const SceneInput& input_;
  RenderTask task_;
  RenderViews views_;
  std::optional<PlannedOutput> film_output_;
  std::optional<ImageOutput> output_;       ///< empty if a part is written
  std::optional<ResumeFile::Names> names_;  ///< empty if no part is kept
  std::optional<ResumeFile> resume_file_;   ///< kept until all is written, because a signal may arrive before
  double load_seconds_ = 0;
  RenderStatistics statistics_;
};

/// Reads several scenes before the first is rendered. Throws InputError if one cannot be read, or if two write the same
/// file.
void check_scenes(const JobRun& run, const std::vector<SceneInput>& scenes) {
  JobContext silent(silent_log(), run.context.options());
  const JobRun quiet{silent, run.args, run.control, run.scenes};
  std::vector<std::pair<std::string, std::string>> outputs;  // the Film's file, and its scene
  for (const SceneInput& input : scenes) {
    if (input.files.back() == "-") continue;  // standard input can be read once only
    RenderTask task(quiet);
    task.read(input);
    for (const auto& [output, scene] : outputs)
      if (is_same_file(output, task.film_file()))
        fail({}, "{} and {} are both written to {}: give their Films a \"filename\" each, or render one with {}", scene,
             input.files.back().string(), output, run.args.spelled("output"));
    outputs.emplace_back(task.film_file(), input.files.back().string());
  }
}

/// The job: renders the scenes one after another.
Result render(const JobRun& run) {
  const std::vector<SceneInput> scenes = scenes_of(run);
  if (scenes.size() > 1 && !run.scenes.empty())
    fail({}, "a scene in memory is rendered alone: call the function once for each of the {} scenes", scenes.size());
  for (const char* name : {"output", "part"})
    if (scenes.size() > 1 && run.args.given(name))
      fail({}, "{} scenes cannot all be written to {}: without it each is written to the file of its Film",
           scenes.size(), run.args.text(name));
  if (scenes.size() > 1 && !run.args.flag("pilot")) check_scenes(run, scenes);
  Result result{.tables = {{"renders"}}};
  std::vector<nlohmann::ordered_json> json;  // of each scene
  for (const SceneInput& input : scenes) {
    SceneRender(run, input).render(result, json);
    if (result.stopped) return result;
  }
  const nlohmann::ordered_json whole = json.size() == 1 ? json[0] : nlohmann::ordered_json(json);
  result.json = whole.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
  return result;
}

}  // namespace

const JobInfo kRenderJob("render", "Render", "Render a pbrt-v4 scene file.", "", kRenderParams, SessionUse::all,
                         render);

}  // namespace frond
