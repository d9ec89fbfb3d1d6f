#include "study/compare/cutoff.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace frond::compare {
namespace {

const double kLogUnshot = std::log(1e-4);
constexpr double kSmallest = 1e-6, kLargest = 0.5;
const double kFirstLogStep = std::log(1.1);
constexpr int kSmallSteps = 4, kMostTries = 16, kMostHalvings = 4;

/// Logarithm of the ratio after a whole number of events, and the counts behind its error.
struct Count {
  double log_ratio, unshot;

  Count(const PathEnds& ends, size_t events) : unshot(double(ends.alive_after(events)) + 0.5) {
    double shot = 0;
    for (size_t i = 0; i < events; ++i) shot += double(ends.alive_after(i));
    log_ratio = std::log(unshot / shot);
  }
};

/// Returns the variance of (1 - t) log a + t log b, where the events of b are a subset of those of a.
double variance(const Count& a, const Count& b, double t) {
  return ((1 - t) * (1 - t) + 2 * t * (1 - t)) / a.unshot + t * t / b.unshot;
}

/// A cutoff, and the logarithms of it and of its ratio over the target: above 0 the cutoff is too small.
struct Try {
  double cutoff, log_cutoff, miss;
};

/// Interpolates the cutoff at the target, linearly in logarithms. The result stays well inside the interval, because
/// the ratio has steps where many paths have the same attenuation.
double interpolate_cutoff(const Try& low, const Try& high) {
  const double t = std::clamp(low.miss / (low.miss - high.miss), 0.1, 0.9);
  return std::exp(std::lerp(low.log_cutoff, high.log_cutoff, t));
}

/// Searches from the first cutoff by growing steps. The ratio jumps where many paths have the same attenuation, and
/// there may be another solution beyond a jump: a step that leads away from the target is halved until the range before
/// the jump has been searched.
class Search {
 public:
  void add(double cutoff, double miss) {
    const Try found{cutoff, std::log(cutoff), miss};
    (miss > 0 ? low_ : high_) = found;
    const bool worse = steps_ > 0 && std::abs(miss) > std::abs(before_.miss);
    (worse ? after_ : before_) = found;
    if (halvings_left_ == 0) {
      ++steps_;
      if (worse) beyond_ = found, halvings_left_ = kMostHalvings;
    } else if (--halvings_left_ == 0) {
      before_ = beyond_;
    }
  }

  /// Returns the next cutoff to try; nullopt if there is none.
  std::optional<double> next() const {
    if (low_ && high_) return interpolate_cutoff(*low_, *high_);
    if (halvings_left_ > 0) return std::sqrt(before_.cutoff * after_.cutoff);
    const double step = std::copysign(std::ldexp(kFirstLogStep, std::max(0, steps_ - kSmallSteps)), before_.miss);
    const double cutoff = std::clamp(std::exp(before_.log_cutoff + step), kSmallest, kLargest);
    return cutoff == before_.cutoff ? std::optional<double>() : cutoff;
  }

 private:
  std::optional<Try> low_, high_;  // a cutoff that is too small, and one that is too large
  Try before_ = {}, after_ = {};   // the last trial; after a step away from the target, the trials nearest to the jump
  Try beyond_ = {};  // the trial that led away; the search continues there after the range before the jump
  int steps_ = 0, halvings_left_ = 0;
};

}  // namespace

UnshotRatio unshot_ratio(const PathEnds& ends, double events) {
  const auto whole = size_t(events);
  const double t = events - double(whole);
  const Count a(ends, whole);
  if (t == 0) return {std::exp(a.log_ratio), 1 / std::sqrt(a.unshot)};
  const Count b(ends, whole + 1);
  return {std::exp(std::lerp(a.log_ratio, b.log_ratio, t)), std::sqrt(variance(a, b, t))};
}

double depth_of_trees(const PathEnds& ends) {
  size_t last = 1;  // first depth with a ratio below the limit, or without rays
  while (last < PathEnds::kDepths - 1 && ends.alive_after(last) > 0 && Count(ends, last).log_ratio >= kLogUnshot)
    ++last;
  if (last == 1) return 1;
  const double before = Count(ends, last - 1).log_ratio, after = Count(ends, last).log_ratio;
  return double(last) - 1 + std::clamp((before - kLogUnshot) / (before - after), 0.0, 1.0);
}

CutoffFit fit_cutoff(const UnshotRatio& target, const std::function<UnshotRatio(double)>& left_by) {
  CutoffFit best{};
  double smallest_miss = INFINITY;
  Search search;
  std::optional<double> cutoff = kPaperCutoff;
  for (int i = 0; i < kMostTries && cutoff && !best.equal; ++i) {
    const UnshotRatio left = left_by(*cutoff);
    const double miss = std::log(left.value / target.value);
    if (std::abs(miss) < smallest_miss) {
      smallest_miss = std::abs(miss);
      best = {*cutoff, left, smallest_miss <= std::hypot(left.relative_error, target.relative_error)};
    }
    search.add(*cutoff, miss);
    cutoff = search.next();
  }
  return best;
}

}  // namespace frond::compare
