#include "study/choose/choice.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/log.h"
#include "study/choose/choice_report.h"
#include "study/choose/screening.h"

namespace frond::choose {
namespace {

/// Samples per pixel, in each of two renders.
constexpr uint64_t kFirstSamples = 8, kMostScreening = 64, kMostSamples = 4096;
/// Number of powers of two between them: how often a configuration may be tested with more samples. The data decide
/// which of these tests are made, but not their positions, so the joint bound holds.
constexpr size_t kLooks = 10;
static_assert(kFirstSamples << (kLooks - 1) == kMostSamples);
/// Share of the final render's paths that a pilot may trace for its comparisons; at least the minimum below.
constexpr double kLargestPart = 0.25;
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
  explicit Chooser(Pilot& pilot) : pilot_(pilot), open_choices_(pilot.open_choices()), reference_(pilot.reference()) {
    choice_.rms = 1;
    for (const OpenChoice& q : open_choices_) {
      base_.push_back(q.base());
      if (q.is_leaf()) choice_.rms = std::min(choice_.rms, q.rms);
    }
    // Bounds of every combination against the reference and of every single option against the base, at each test, from
    // above and below: this covers every comparison the pilot can make.
    choice_.comparisons = size_t{2} * 2 * kLooks * count_combinations(open_choices_);
    z_ = normal_upper_quantile(sidak_level(1 - kConfidence, choice_.comparisons));
    choice_.samples = pilot.scene_samples();
    weights_ = weights();
  }

  /// Returns the selected configuration.
  Configuration run() {
    screen();
    const Configuration chosen = search();
    describe(chosen);
    return chosen;
  }
  const Choice& choice() const { return choice_; }

 private:
  double request() const { return choice_.rms * choice_.rms; }

  Bounds bounds(const Configuration& answers, const Configuration& from) const {
    const Estimate e = mean_square(pilot_.difference(answers, from));
    const ConfidenceInterval interval = mean_square_interval(e, z_);
    return {interval, e.mean, interval.high - e.mean};
  }

  Configuration single(size_t open_choice, size_t option) const {
    Configuration answers = base_;
    answers[open_choice] = option;
    return answers;
  }

  /// Renders every single option until its bias is known well enough to select by.
  void screen() {
    std::vector<Configuration> singles;
    for (size_t q = 0; q < open_choices_.size(); ++q)
      for (size_t option = 0; option < base_[q]; ++option) singles.push_back(single(q, option));
    for (samples_ = kFirstSamples;; samples_ *= 2) {
      pilot_.render(base_, samples_);
      for (const Configuration& s : singles) pilot_.render(s, samples_);
      if (samples_ >= kMostScreening || std::ranges::all_of(singles, [this](const auto& s) { return is_clear(s); }))
        break;
    }
  }

  bool is_clear(const Configuration& single) const {
    const Estimate e = mean_square(pilot_.difference(single, base_));
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

  /// Returns an option's price as a factor on the base's.
  double price(size_t open_choice, size_t option) const {
    const auto& options = open_choices_[open_choice].options;
    const double weight = open_choices_[open_choice].is_leaf() ? weights_[open_choice] : 1;
    return 1 + weight * (options[option].price / options[base_[open_choice]].price - 1);
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
      for (size_t option = 0; option < base_[q]; ++option) {
        const OptionResult& found = findings_[q].emplace_back(finding(q, option));
        singles[q].push_back({found.price, found.noise, differences.size()});
        differences.push_back(pilot_.difference(single(q, option), base_));
      }
      findings_[q].push_back(finding(q, base_[q]));
      singles[q].push_back({.is_base = true});
    }
    std::vector<std::vector<double>> products(differences.size());
    for (size_t i = 0; i < differences.size(); ++i)
      for (const PairedDifference& other : differences) products[i].push_back(mean_product(differences[i], other));
    return {std::move(singles), std::move(products), {pilot_.noise(base_), {}}};
  }

  OptionResult finding(size_t open_choice, size_t option) const {
    const Configuration answers = single(open_choice, option);
    const Bounds b = bounds(answers, base_);
    const double noise = pilot_.noise(answers).back().noise.value, base = pilot_.noise(base_).back().noise.value;
    return {open_choices_[open_choice].options[option].name,
            price(open_choice, option),
            base > 0 ? noise / base : 1,
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
      if (answers == reference_) return reference_without_bias();
      if (meets_request(answers)) return answers;
      const size_t worst = guess.worst(answers);
      if (worst == open_choices_.size()) break;
      floor[worst] = answers[worst] + 1;
    }
    choice_.ground = Choice::Ground::nothing_meets;
    return reference_without_bias();
  }

  /// Selects the reference, regardless of earlier trials.
  const Configuration& reference_without_bias() {
    choice_.bias = {};
    choice_.bias_estimate = 0;
    return reference_;
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
      if (!told && grow(b.uncertainty)) continue;
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
  bool grow(double uncertainty) {
    constexpr double kAtMostFaster = 8;
    const uint64_t limit = most_samples();
    const double at_limit = uncertainty * double(samples_) / double(limit);
    if (samples_ >= limit || at_limit > kAtMostFaster * request()) return false;
    const double factor = std::clamp(uncertainty / (kSharp * request()), 2.0, 8.0);
    samples_ = std::min(limit, std::bit_ceil(uint64_t(double(samples_) * factor)));
    return true;
  }

  uint64_t most_samples() const {
    const double paths =
        double(pilot_.film().crop.width()) * double(pilot_.film().crop.height()) * double(choice_.samples);
    const auto samples = uint64_t(kLargestPart * paths / (4 * double(pilot_.cost().pixels)));
    return std::bit_floor(std::clamp(samples, kLeastLimit, kMostSamples));
  }

  void describe(const Configuration& chosen) {
    for (size_t q = 0; q < open_choices_.size(); ++q) {
      const OpenChoice& open_choice = open_choices_[q];
      choice_.answers.push_back({open_choice.name, open_choice.is_leaf(), open_choice.options[chosen[q]].name,
                                 pilot_.share(open_choice), open_choice.options[base_[q]].name, findings_[q],
                                 open_choice.refused});
    }
    pilot_.render(reference_, samples_);
    choice_.reference = open_choices_.back().options.back().name;
    choice_.noise = priced_noise(chosen), choice_.reference_noise = priced_noise(reference_);
    choice_.pilot_samples = samples_;
    choice_.pilot = pilot_.cost();
  }

  std::vector<ConvergencePoint> priced_noise(const Configuration& answers) const {
    std::vector<ConvergencePoint> points = pilot_.noise(answers);
    for (ConvergencePoint& p : points) p.seconds = p.samples * price(answers);
    return points;
  }

  Pilot& pilot_;
  const std::vector<OpenChoice>& open_choices_;
  Configuration reference_, base_;
  std::vector<double> weights_;
  ByOption<OptionResult> findings_;
  double z_ = 0;
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

double Choice::time_saved() const { return reference_effort().seconds / effort().seconds; }

std::optional<Chosen> choose_models(const ChoiceTask& task, const Ladder& ladder, const Log& log) {
  if (!has_open_leaf(task.description)) return {};
  Pilot pilot(task, ladder);
  if (!pilot.has_colors()) {
    log.warn({}, "a leaf's model is chosen by images of colours, and bands are none: leaves without \"model\" are abm");
    return {};
  }
  Chooser chooser(pilot);
  put_answers(pilot.open_choices(), chooser.run(), task.session.registry(), task.description);
  return Chosen{chooser.choice(), pilot.scene()};
}

std::optional<Chosen> choose_for(Session& session, SceneDescription& description, uint64_t samples,
                                 ImageRequest& request) {
  const Log& log = session.log();
  auto chosen = choose_models({session, description, samples}, standard_ladder(session.registry()), log);
  if (!chosen) return {};
  const Choice& choice = chosen->choice;
  log.info(choice_text(choice));
  if (const std::string warning = choice_warning(choice); !warning.empty()) log.warn({}, warning);
  request.attributes = choice_attributes(choice);
  const bool chose_wavelengths = !choice.answers.front().is_leaf;
  if (chose_wavelengths && request.color_space.empty()) request.color_space = "linear sRGB";
  return chosen;
}

}  // namespace frond::choose
