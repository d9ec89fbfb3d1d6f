#include "study/choose/choice.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/log.h"
#include "scene/leaf_models.h"
#include "study/choose/choice_report.h"
#include "study/choose/screening.h"

namespace frond::choose {
namespace {

/// Samples per pixel, in each of two renders.
constexpr uint64_t kMostScreening = 64, kMostSamples = 4096;
/// Number of powers of two between them: how often a configuration may be tested with more samples. The data decide
/// which of these tests are made, but not their positions, so the joint bound holds.
constexpr size_t kLooks = 10;
static_assert(kFirstSamples << (kLooks - 1) == kMostSamples);
/// Share of the time that the cheapest options could save which a pilot may take.
constexpr double kLargestPart = 0.25;
/// Share of the final render's paths that a pilot may trace if the selection itself is requested, and the least number
/// of samples that it may then take.
constexpr double kLargestPartOfQuestion = 0.25;
constexpr uint64_t kLeastLimit = 64;

/// More samples are taken until a bound of a mean square exceeds its estimate by at most this share of the request.
constexpr double kSharp = 0.25;

/// One-sided 95 % quantile for the upper bound of noise.
constexpr double kNoiseZ = 1.645;

double root(double square) { return std::sqrt(std::max(0.0, square)); }

/// Estimate of a mean square with bounds.
struct Bounds {
  ConfidenceInterval square;
  double estimate;
  double uncertainty;  ///< upper bound minus estimate

  RmsBounds rms() const { return {root(square.low), root(square.high)}; }
};

size_t count_combinations(const std::vector<OpenChoice>& open_choices) {
  double product = 1;
  for (const OpenChoice& q : open_choices) product *= double(q.options.size());
  return size_t(std::min(product, 1e15));
}

/// Searches for the cheapest models that meet the error bound.
class Chooser {
 public:
  Chooser(Pilot& pilot, bool is_question)
      : pilot_(pilot), open_choices_(pilot.open_choices()), reference_(pilot.reference()) {
    choice_.rms = pilot.request();
    choice_.is_relative = pilot.is_relative();
    // Bounds of every combination against the reference, at each test, from above and below: this covers every
    // comparison the pilot can make.
    choice_.comparisons = size_t{2} * kLooks * count_combinations(open_choices_);
    z_ = normal_upper_quantile(sidak_level(1 - kConfidence, choice_.comparisons));
    choice_.samples = pilot.scene_samples();
    weights_ = weights();
    for (size_t q = 0; q < open_choices_.size(); ++q)
      for (size_t option = 0; option < reference_[q]; ++option) singles_.push_back(single(q, option));
    limit_ = is_question ? limit_of_question() : limit_of_gain();
  }

  /// Returns the selected configuration.
  Configuration run() {
    Configuration chosen = reference_;
    try {
      chosen = selected();
    } catch (const Pilot::OutOfTime&) {
      use_reference(Choice::Ground::no_time);
    }
    describe(chosen);
    return chosen;
  }
  const Choice& choice() const { return choice_; }

 private:
  double request() const { return choice_.rms * choice_.rms; }

  double render_paths() const {
    const Crop& crop = pilot_.film().crop;
    return double(crop.width()) * double(crop.height()) * double(choice_.samples);
  }

  /// Paths of the pilot that take a share of what the cheapest options could save.
  double limit_of_gain() const {
    const Configuration cheapest(open_choices_.size(), 0);
    return kLargestPart * (1 - price(cheapest)) * render_paths();
  }
  double limit_of_question() const {
    const double least = double(kLeastLimit) * 2 * double(pilot_.pixels()) * double(singles_.size() + 2);
    return std::max(kLargestPartOfQuestion * render_paths(), least);
  }

  /// Whether the limit allows this number of samples in so many configurations.
  bool is_within_limit(uint64_t samples, size_t configurations) const {
    return 2 * double(samples) * double(pilot_.pixels()) * double(configurations) <= limit_;
  }

  Configuration selected() {
    // The reference, each option alone, and a combination.
    if (singles_.empty()) return use_reference(Choice::Ground::reference);
    if (!is_within_limit(kFirstSamples, singles_.size() + 2)) return use_reference(Choice::Ground::no_gain);
    screen_options();
    return search();
  }

  /// Selects the reference, regardless of earlier trials.
  const Configuration& use_reference(Choice::Ground ground) {
    choice_.ground = ground;
    choice_.bias = {};
    choice_.bias_estimate = 0;
    return reference_;
  }

  Bounds bounds(const Configuration& answers, const Configuration& from) const {
    const Estimate e = mean_square(pilot_.difference(answers, from));
    const ConfidenceInterval interval = mean_square_interval(e, z_);
    return {interval, e.mean, interval.high - e.mean};
  }

  Configuration single(size_t open_choice, size_t option) const {
    Configuration answers = reference_;
    answers[open_choice] = option;
    return answers;
  }

  /// Renders every single option until its bias is known well enough to select by.
  void screen_options() {
    for (samples_ = kFirstSamples;; samples_ *= 2) {
      pilot_.render(reference_, samples_);
      for (const Configuration& s : singles_) pilot_.render(s, samples_);
      if (samples_ >= kMostScreening ||
          std::ranges::all_of(singles_, [this](const auto& s) { return has_small_error(s); }) ||
          !is_within_limit(2 * samples_, singles_.size() + 2))
        break;
    }
  }

  bool has_small_error(const Configuration& single) const {
    const Estimate e = mean_square(pilot_.difference(single, reference_));
    return e.standard_error() < std::max(request(), e.mean) / 8;
  }

  /// Returns the shares of visible leaves; leaves that only light paths reach have none.
  std::vector<double> weights() const {
    std::vector<double> result;
    for (const OpenChoice& q : open_choices_) result.push_back(q.is_leaf() ? pilot_.share(q) : 0);
    const double sum = std::accumulate(result.begin(), result.end(), 0.0);
    for (double& w : result) w = sum > 0 ? w / sum : 1 / double(result.size());
    return result;
  }

  /// Returns an option's price as a factor on the reference's.
  double price(size_t open_choice, size_t option) const {
    const auto& options = open_choices_[open_choice].options;
    const double weight = open_choices_[open_choice].is_leaf() ? weights_[open_choice] : 1;
    return 1 + weight * (options[option].price / options[reference_[open_choice]].price - 1);
  }

  double price(const Configuration& answers) const {
    double product = 1;
    for (size_t q = 0; q < answers.size(); ++q) product *= price(q, answers[q]);
    return product;
  }

  /// Builds the screening, and keeps the results of single options for the report.
  Screening screening() {
    ByOption<Screening::Single> singles(open_choices_.size());
    std::vector<PairedDifference> differences;
    findings_.resize(open_choices_.size());
    for (size_t q = 0; q < open_choices_.size(); ++q) {
      for (size_t option = 0; option < reference_[q]; ++option) {
        const OptionResult& found = findings_[q].emplace_back(finding(q, option));
        singles[q].push_back({found.price, found.noise, differences.size()});
        differences.push_back(pilot_.difference(single(q, option), reference_));
      }
      findings_[q].push_back(finding(q, reference_[q]));
      singles[q].push_back({.is_reference = true});
    }
    std::vector<std::vector<double>> products(differences.size());
    for (size_t i = 0; i < differences.size(); ++i)
      for (const PairedDifference& other : differences) products[i].push_back(mean_product(differences[i], other));
    return {std::move(singles), std::move(products), {pilot_.noise(reference_), {}}};
  }

  OptionResult finding(size_t open_choice, size_t option) const {
    const Configuration answers = single(open_choice, option);
    const Bounds b = bounds(answers, reference_);
    const double noise = pilot_.noise(answers).back().noise.value;
    const double of_reference = pilot_.noise(reference_).back().noise.value;
    return {open_choices_[open_choice].options[option].name,
            price(open_choice, option),
            of_reference > 0 ? noise / of_reference : 1,
            root(b.estimate),
            b.rms(),
            pilot_.cpu_us_per_path(answers)};
  }

  /// Tests the cheapest configuration first. If it is not shown to meet the request, the option with the largest bias
  /// is improved.
  Configuration search() {
    const Screening guess = screening();
    Configuration floor(open_choices_.size(), 0);
    for (;;) {
      const Configuration answers = guess.cheapest(floor, choice_.rms);
      if (answers == reference_) return use_reference(Choice::Ground::reference);
      if (meets_request(answers)) {
        choice_.causes = causes(guess, answers);
        return answers;
      }
      floor[guess.worst(answers)] += 1;
    }
  }

  Causes causes(const Screening& guess, const Configuration& answers) const {
    Causes causes;
    Configuration leaves = answers, wavelengths = reference_;
    for (size_t q = 0; q < open_choices_.size(); ++q)
      if (!open_choices_[q].is_leaf()) leaves[q] = reference_[q], wavelengths[q] = answers[q];
    causes.leaves = root(guess.bias(leaves));
    causes.wavelengths = root(guess.bias(wavelengths));
    const PairedDifference shift = pilot_.difference(wavelengths, reference_);
    for (const std::vector<float>& half : shift.half)
      for (size_t i = 0; i < half.size(); ++i)
        causes.mean_shift[i % 3] += double(half[i]) / (2 * double(shift.pixels()));
    return causes;
  }

  /// Adds samples until the bounds decide, or until the limit. All bounds hold jointly, so the narrowest one counts.
  bool meets_request(const Configuration& answers) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    ConfidenceInterval known{0, kInfinity};
    for (double last = kInfinity;;) {
      const uint64_t samples = samples_;
      pilot_.render(reference_, samples);
      pilot_.render(answers, samples);
      const Bounds b = bounds(answers, reference_);
      known = {std::max(known.low, b.square.low), std::min(known.high, b.square.high)};
      choice_.bias = {root(known.low), root(known.high)};
      choice_.bias_estimate = root(std::clamp(b.estimate, known.low, known.high));
      const bool met = known.high <= request(), sharp = b.uncertainty < kSharp * request();
      const bool helps = b.uncertainty < 0.8 * last;  // variation among pixels does not decrease with samples
      const bool told = known.low > request() || (met && (sharp || !helps));
      last = b.uncertainty;
      if (!told && add_samples(b.uncertainty)) continue;
      choice_.out_of_samples = choice_.out_of_samples || (!told && !met);
      choice_.trials.push_back({names_of(answers), {root(known.low), root(known.high)}, samples});
      return met;
    }
  }

  std::vector<std::string> names_of(const Configuration& answers) const {
    std::vector<std::string> names;
    for (size_t q = 0; q < answers.size(); ++q) names.push_back(open_choices_[q].options[answers[q]].name);
    return names;
  }

  /// The noise of a squared bias falls as 1 / samples, or faster if few pixels contribute most of it.
  bool add_samples(double uncertainty) {
    constexpr double kAtMostFaster = 8;
    const uint64_t limit = std::max(samples_, most_samples());
    const double at_limit = uncertainty * double(samples_) / double(limit);
    if (samples_ >= limit || at_limit > kAtMostFaster * request()) return false;
    const double factor = std::clamp(uncertainty / (kSharp * request()), 2.0, 8.0);
    samples_ = std::min(limit, std::bit_ceil(uint64_t(double(samples_) * factor)));
    return true;
  }

  /// Samples for the reference and one configuration that use up the limit.
  uint64_t most_samples() const {
    const double pixels = double(pilot_.pixels()),
                 left = limit_ - double(pilot_.paths()) + 4 * pixels * double(samples_);
    return std::bit_floor(uint64_t(std::clamp(left / (4 * pixels), 1.0, double(kMostSamples))));
  }

  void describe(const Configuration& chosen) {
    for (size_t q = 0; q < open_choices_.size(); ++q) {
      const OpenChoice& open_choice = open_choices_[q];
      choice_.answers.push_back({open_choice.name, open_choice.is_leaf(), open_choice.options[chosen[q]].name,
                                 pilot_.share(open_choice), open_choice.options[reference_[q]].name,
                                 findings_.empty() ? std::vector<OptionResult>() : findings_[q], open_choice.refused});
    }
    choice_.price = price(chosen);
    choice_.pilot_samples = samples_;
    choice_.pilot = pilot_.cost();
    if (findings_.empty() || choice_.ground == Choice::Ground::no_time) return;
    choice_.noise = priced_noise(chosen), choice_.reference_noise = priced_noise(reference_);
    choice_.reference_seconds = pilot_.cpu_us_per_path(reference_) * 1e-6 * render_paths();
  }

  std::vector<ConvergencePoint> priced_noise(const Configuration& answers) const {
    std::vector<ConvergencePoint> points = pilot_.noise(answers);
    for (ConvergencePoint& p : points) p.seconds = p.samples * price(answers);
    return points;
  }

  Pilot& pilot_;
  const std::vector<OpenChoice>& open_choices_;
  Configuration reference_;
  std::vector<Configuration> singles_;  ///< one option changed in each
  std::vector<double> weights_;
  ByOption<OptionResult> findings_;
  double z_ = 0, limit_ = 0;  ///< limit: of the pilot's paths
  uint64_t samples_ = 0;
  Choice choice_;
};

}  // namespace

double Choice::noise_rms() const { return std::sqrt(Convergence(noise, {}).noise_after(double(samples))); }

namespace {

/// Rounds up to a power of two, at which low-discrepancy samples converge best and were measured.
Effort rounded_up(const std::optional<Effort>& effort) {
  if (!effort) return {1, 1, false};  // bias alone uses the whole error
  const double samples = std::exp2(std::ceil(std::log2(effort->samples)));
  return {samples, effort->seconds * samples / effort->samples, effort->measured};
}

}  // namespace

Effort Choice::effort() const {
  return rounded_up(Convergence(noise, {bias_estimate * bias_estimate, 0}).until_rms(rms, kNoiseZ));
}

Effort Choice::reference_effort() const { return rounded_up(Convergence(reference_noise, {}).until_rms(rms, kNoiseZ)); }

double Choice::samples_needed() const { return effort().samples; }

double Choice::reference_samples_needed() const { return reference_effort().samples; }

std::optional<Chosen> choose_models(const ChoiceTask& task, const Ladder& ladder, const Log& log) {
  const Registry& registry = task.session.registry();
  if (!has_open_leaf(task.description, registry)) return {};
  Pilot pilot(task, ladder);
  if (!pilot.has_colors()) {
    log.warn({}, fmt::format(
                     "a leaf's model is chosen by images of colours, and bands are none: leaves without \"model\" are "
                     "{}",
                     noiseless_model(registry).name));
    return {};
  }
  Chooser chooser(pilot, task.is_question);
  apply_answers(pilot.open_choices(), chooser.run(), registry, task.description);
  return Chosen{chooser.choice(), pilot.scene()};
}

std::optional<Chosen> choose_for(const ChoiceTask& task, ImageRequest& request) {
  const Log& log = task.session.log();
  auto chosen = choose_models(task, standard_ladder(task.session.registry()), log);
  if (!chosen) return {};
  const Choice& choice = chosen->choice;
  log.info(choice_text(choice));
  request.attributes = choice_attributes(choice);
  const bool chose_wavelengths = !choice.answers.front().is_leaf;
  if (chose_wavelengths && request.color_space.empty()) request.color_space = "linear sRGB";
  return chosen;
}

}  // namespace frond::choose
