#include "jobs/support/render_task.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "cameras/films.h"
#include "core/messages/problems.h"
#include "jobs/record/common_params.h"
#include "render/film/adaptive.h"
#include "scene/format/words.h"
#include "spectra/color/color_management.h"
#include "spectra/color/color_space.h"
#include "system/file_uses.h"

namespace frond {
namespace {

/// Returns the crop of the arguments, or of the scene. Throws InputError if it contains no pixel.
Crop crop_of(const Arguments& args, const FilmSettings& film, const Log& log) {
  const char* name = args.given("pixel") ? "pixel" : args.given("pixels") ? "pixels" : "crop";
  std::vector<double> bounds = args.numbers(name);
  if (bounds.empty()) return film.crop;
  if (bounds.size() == 2) bounds = {bounds[0], bounds[0] + 1, bounds[1], bounds[1] + 1};
  if (put_in_order(bounds))
    log.warn({}, fmt::format("the crop's ends are the wrong way round: taken for {}", fmt::join(bounds, ",")));
  const Crop crop = args.given("crop")
                        ? crop_of_fractions(bounds, film.width, film.height)
                        : crop_of_pixels(std::vector<int>(bounds.begin(), bounds.end()), film.width, film.height);
  if (crop.width() <= 0 || crop.height() <= 0)
    fail({}, "{} {} holds no pixel of the {} x {} film: {} is needed", args.spelled(name), args.words(name)[0],
         film.width, film.height,
         args.given("pixel") ? fmt::format("x,y up to {},{}", film.width - 1, film.height - 1) : "x0,x1,y0,y1");
  return crop;
}

/// Throws InputError for what the load, which may take minutes, would find wrong only at its end.
void check_early(const Arguments& args, const std::vector<std::string>& channels) {
  (void)ChannelList(channels);
  if (std::array<float, 3> any{}; args.given("color-space"))
    ColorManager().convert(any, kXyzName, args.text("color-space"));
  if (args.given("max-rms") && args.given("spp") && uint64_t(args.count("spp")) < kLeastAdaptive)
    fail({}, "{}: at least {} samples per pixel are needed to estimate the noise, {} allows {}",
         args.spelled("max-rms"), kLeastAdaptive, args.spelled("spp"), args.count("spp"));
}

}  // namespace

SampleRange sample_range_of(const Arguments& args, const std::string& amount) {
  const std::string text = args.text("samples");
  const auto ends = split(text, ':');
  SampleRange range;
  const auto read = [](const std::string& word, uint64_t& value) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size();
  };
  const auto most = uint64_t(args.count(amount));
  if (ends.size() != 2 || !read(ends[0], range.begin) || !read(ends[1], range.end) || range.empty() ||
      (most == 0 && range.end > 1u << 30))
    fail({}, "{} takes FIRST:END, such as 64:128 for samples 64 to 127: \"{}\"", args.spelled("samples"), text);
  if (most > 0 && range.end > most)
    fail({}, "{} {} ends above {} {}", args.spelled("samples"), text, args.spelled(amount), most);
  return range;
}

void RenderTask::read(const SceneInput& input) {
  Problems problems;
  Session& session = run_.session();
  description_ = read_scene(run_, input, problems);
  settings_ = description_;
  apply_scene_flags(run_.args, description_);
  // If files have errors, the errors of the scene are reported as well.
  if (!problems.empty() && !description_.files.empty()) problems.attempt([&] { session.check(description_); });
  problems.check();
  apply_arguments();
}

void RenderTask::read_text(const std::string& text, const std::string& name) {
  description_ = run_.session().read_text(text, name, unsupported_of(run_.args));
  settings_ = description_;
  apply_scene_flags(run_.args, description_);
  apply_arguments();
}

/// Symbolic links are resolved first; a folder that does not exist is no link.
const std::string& RenderTask::film_file() const {
  check_file_name(film_file_, "the scene's Film", film_where_);
  std::error_code error;
  const auto here = std::filesystem::canonical(".", error);
  const auto target = std::filesystem::weakly_canonical(here / film_file_, error);
  if (error || std::mismatch(here.begin(), here.end(), target.begin(), target.end()).first != here.end())
    fail(film_where_, "the scene asks to write \"{}\", which is not in the working folder: give a file with -o",
         film_file_);
  return film_file_;
}

/// Applies overrides and the crop. The crop is evaluated at full size and then halved for --quick.
void RenderTask::apply_arguments() {
  const Arguments& args = run_.args;
  Session& session = run_.session();
  FilmSettings film = session.film(description_);  // at full size, because crops refer to its pixels
  apply_overrides(overrides_of(args), description_, session.registry(), run_.log());
  film.crop = crop_of(args, film, run_.log());
  if (args.flag("quick")) film = halved(film);
  film_file_ = film.filename;
  film_where_ = description_.film.where;
  for (const Location& place : {film_where_, description_.integrator.where})
    if (place.file) where_ = place;
  if (args.given("samples")) samples_ = sample_range_of(args, "spp");
  std::vector<std::string> channels;
  if (const std::string text = args.text("channels"); !text.empty()) channels = split(text, ',');
  if (args.flag("for-denoiser")) {
    channels.emplace_back("normal");
    const bool has_colors = !make_wavelengths(description_, session.registry())->film_space().empty();
    if (has_colors) channels.emplace_back("albedo");  // a colour, which a film of bands cannot hold
  }
  check_early(args, channels);
  request_ = {.pixels = film.crop,
              .is_part = args.given("part"),
              .channels = channels,
              .color_space = args.text("color-space"),
              .adaptive = is_adaptive(),
              .command = identifying_command(kRenderJob, args)};
}

/// Channels are checked first, because the selection of models may take minutes.
void RenderTask::choose(const ImageOutput* output, std::optional<std::chrono::steady_clock::time_point> deadline) {
  Session& session = run_.session();
  if (output) output->check_channels(make_wavelengths(description_, session.registry())->film_space());
  auto chosen = choose::choose_for({.session = session,
                                    .description = description_,
                                    .samples = uint64_t(run_.args.count("spp")),
                                    .is_question = run_.args.flag("pilot"),
                                    .deadline = deadline},
                                   request_);
  if (!chosen) return;
  choice_ = std::move(chosen->choice);
  pilot_ = std::move(chosen->scene);
}

/// Consumes the description: shapes may be large.
void RenderTask::load(const ImageOutput* output) {
  const Arguments& args = run_.args;
  scene_.emplace(run_.session().load(std::move(description_), request_, pilot_.get()));
  if (pilot_)  // the pilot has loaded the scene without log messages, and its lights are reused
    for (const Light* light : scene_->scene().lights())
      if (const std::string summary = light->summary(); !summary.empty()) run_.log().info(summary);
  if (!args.given("samples")) samples_ = {0, args.given("spp") ? uint64_t(args.count("spp")) : scene_->samples()};
  scene_->check_samples(samples_.count());
  if (output) output->check(scene_->image_format());
}

RenderPart RenderTask::empty_part() const {
  RenderPart part = scene_->empty_part();
  part.header.request = samples_.end;
  return part;
}

/// With --max-rms, --spp is the largest number of samples of a pixel.
RenderStatistics RenderTask::render(RenderPart& part, const RenderControl& control,
                                    const decltype(NoiseRequest::on_change)& on_change) const {
  Session& session = run_.session();
  if (!is_adaptive()) return session.render(*scene_, samples_, part, control);
  NoiseRequest request{
      .max_rms = run_.args.real("max-rms"), .is_relative = run_.args.is_relative("max-rms"), .on_change = on_change};
  if (run_.args.given("spp")) request.most_samples = samples_.count();
  return session.render_to(*scene_, request, part, control);
}

}  // namespace frond
