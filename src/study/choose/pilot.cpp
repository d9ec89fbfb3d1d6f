#include "study/choose/pilot.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_set>

#include "core/math/random.h"
#include "core/stop.h"
#include "study/choose/pilot_pixels.h"
#include "system/machine.h"

namespace frond::choose {
namespace {

/// Enough to estimate a mean square to 8 % if pixels vary by five times their mean. More samples of fewer pixels
/// estimate bias better than fewer of more: its noise falls with samples times the square root of pixels.
constexpr size_t kPixels = 4096;

/// The final render uses other seeds.
enum SeedUse : uint64_t { kFirstHalf = 0x70696c6f74, kSecondHalf, kPixelSeed };

/// Returns a film with one row of pixels.
FilmSettings row_of(const FilmSettings& film, size_t pixels) {
  FilmSettings row = film;
  row.width = int(pixels), row.height = 1;
  row.crop = {0, 0, row.width, 1};
  return row;
}

/// Estimates noise from the difference of two halves. A pixel's channels are correlated and count as one observation.
MeanSquare noise_of(const std::array<std::vector<float>, 2>& halves) {
  Moments squares;
  for (size_t i = 0; i + 2 < halves[0].size(); i += 3) {
    double sum = 0;
    for (size_t c = i; c < i + 3; ++c) {
      const double gap = double(halves[0][c]) - double(halves[1][c]);
      sum += gap * gap / 2;
    }
    squares.add(sum / 3);
  }
  return {squares.mean(), squares.estimate().standard_error()};
}

}  // namespace

struct Pilot::Render {
  std::unique_ptr<Scene> scene;
  PairedFilms films;
  std::vector<ConvergencePoint> noise = {};
};

Pilot::Pilot(const ChoiceTask& task, const Ladder& ladder)
    : task_(task),
      film_(task.session.film(task.description)),
      start_cpu_seconds_(cpu_seconds()),
      variant_{task.description, {}, {}, {}} {  // NOLINT(cppcoreguidelines-slicing): the settings alone
  Session& session = task.session;
  const Registry& registry = session.registry();
  SceneDescription& description = task.description;
  if (!names_wavelengths(description)) {
    open_choices_.push_back({"wavelengths", {}, {}, ladder.wavelengths});
    apply_answers(open_choices_, reference(), registry, description);
  }
  scene_ = std::make_shared<const Scene>(description, registry, session.pool(), quiet_, session.cache(), task.other,
                                         &shared_);
  exponent_ = film_exponent(job_of(*scene_), scene_->film().exposure);
  const auto leaves = open_leaves(description, registry, scene_->wavelengths(), ladder);
  open_choices_.insert(open_choices_.end(), leaves.begin(), leaves.end());
  pixels_ = pilot_pixels(film_.crop, kPixels, hash_key(scene_->seed(), uint64_t{kPixelSeed}));
  if (has_colors()) set_unit();
}

Pilot::~Pilot() = default;

bool Pilot::has_colors() const { return scene_->wavelengths().bands().empty(); }

uint64_t Pilot::scene_samples() const {
  return task_.samples > 0 ? task_.samples : uint64_t(scene_->samples_per_pixel());
}

Configuration Pilot::reference() const {
  Configuration answers;
  for (const OpenChoice& q : open_choices_) answers.push_back(q.reference());
  return answers;
}

Pilot::Render Pilot::make(const Configuration& answers) {
  Session& session = task_.session;
  variant_.materials = task_.description.materials;
  apply_answers(open_choices_, answers, session.registry(), variant_);
  auto scene = std::make_unique<Scene>(variant_, session.registry(), session.pool(), quiet_, session.cache(),
                                       scene_.get(), &shared_);
  const auto seed = [this](SeedUse use) { return hash_key(scene_->seed(), uint64_t{use}); };
  PairedFilms films(row_of(film_, pixels_.size()), exponent_, {seed(kFirstHalf), seed(kSecondHalf)}, variant_,
                    session.registry(), *scene, pixels_);
  return {std::move(scene), std::move(films)};
}

/// A relative limit needs the channels' means, from a short render of the reference. With both kinds of limit, the
/// smaller one of each channel counts.
void Pilot::set_unit() {
  ErrorLimits limits;
  for (const OpenChoice& q : open_choices_)
    if (q.is_leaf()) limits = smaller(limits, q.limits);
  is_relative_ = std::isfinite(limits.relative);
  request_ = is_relative_ ? limits.relative : limits.absolute;
  if (!is_relative_) return;
  std::array<double, 3> mean{};
  try {
    render(reference(), kFirstSamples);
  } catch (const OutOfTime&) {
    return;  // the search ends before it uses the unit
  }
  for (const auto& half : images(rendered(reference())))
    for (size_t i = 0; i < half.size(); ++i) mean[i % 3] += double(half[i]) / (2 * double(pixels_.size()));
  for (size_t c = 0; c < 3; ++c) {
    if (!(mean[c] > 0))
      fail(task_.description.materials[open_choices_.back().materials.front()].plugin.where,
           "\"maxrelativerms\" needs light of every colour: the image's mean of red, green or blue is not above 0");
    unit_[c] = std::min(limits.absolute, limits.relative * mean[c]) / limits.relative;
  }
  renders_.clear();  // its noise is in the other unit
}

void Pilot::render(const Configuration& answers, uint64_t samples) {
  const DeadlineScope limit(task_.deadline);
  try {
    check_stop();
    advance(answers, samples);
  } catch (const Stopped&) {
    if (task_.deadline && std::chrono::steady_clock::now() >= *task_.deadline) throw OutOfTime();
    throw;
  }
}

void Pilot::advance(const Configuration& answers, uint64_t samples) {
  auto found = renders_.find(answers);
  if (found == renders_.end()) found = renders_.emplace(answers, make(answers)).first;
  Render& r = found->second;
  while (r.films.samples() < samples) {
    const uint64_t next = r.films.samples() == 0 ? std::min(samples, kFirstSamples)
                                                 : std::min(samples, std::bit_floor(r.films.samples()) * 2);
    r.films.advance_to(next, *r.scene, task_.session.pool(), nullptr);
    r.noise.push_back({double(next), 0, noise_of(images(r))});
  }
}

const Pilot::Render& Pilot::rendered(const Configuration& answers) const { return renders_.at(answers); }

Pilot::Halves Pilot::images(const Render& render) const {
  Halves halves;
  for (size_t i = 0; i < 2; ++i) {
    for (int x = 0; x < int(pixels_.size()); ++x)
      for (const double value : render.films.film(i).mean(x, 0)) halves[i].push_back(float(value));
    colors_.convert(halves[i], render.scene->wavelengths().film_space(), "linear SMPTE-C");
    if (is_relative_)
      for (size_t k = 0; k < halves[i].size(); ++k) halves[i][k] /= float(unit_[k % 3]);
  }
  return halves;
}

PairedDifference Pilot::difference(const Configuration& answers, const Configuration& from) const {
  PairedDifference d{images(rendered(answers)), 3};
  const Halves other = images(rendered(from));
  for (size_t i = 0; i < 2; ++i) std::ranges::transform(d.half[i], other[i], d.half[i].begin(), std::minus<>());
  return d;
}

const std::vector<ConvergencePoint>& Pilot::noise(const Configuration& answers) const {
  return rendered(answers).noise;
}

double Pilot::cpu_us_per_path(const Configuration& answers) const {
  const Render& r = rendered(answers);
  return r.films.cost().cpu_seconds * 1e6 / (double(r.films.samples()) * double(pixels_.size()));
}

double Pilot::share(const OpenChoice& open_choice) const {
  const Scene& scene = *scene_;
  std::unordered_set<const Material*> asked;
  for (const size_t place : open_choice.materials) asked.insert(scene.material(place));
  const auto sees = [&](const PixelPosition& p) {
    SurfacePoint point;
    const Ray ray = scene.camera().ray({float(p.x) + 0.5f, float(p.y) + 0.5f}, {0.5f, 0.5f});
    return scene.intersect(ray, hash_key(scene.seed(), p.x, p.y), point) && asked.contains(point.material);
  };
  return double(std::ranges::count_if(pixels_, sees)) / double(pixels_.size());
}

PilotCost Pilot::cost() const {
  return {.pixels = pixels_.size(), .paths = paths(), .cpu_seconds = cpu_seconds() - start_cpu_seconds_};
}

uint64_t Pilot::paths() const {
  uint64_t paths = 0;
  for (const auto& [answers, r] : renders_) paths += 2 * r.films.samples() * pixels_.size();
  return paths;
}

}  // namespace frond::choose
