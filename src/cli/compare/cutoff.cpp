#include "cli/compare/cutoff.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace frond::compare {
namespace {

constexpr double kUnshotRatio = 1e-4;
constexpr double kSmallest = 1e-6, kLargest = 0.5, kStep = 4;
constexpr int kMostTries = 8;

/// Half a ray more, as none has no logarithm.
double padded(const Unshot& rays) { return double(rays.unshot) + 0.5; }

/// Logarithm of one ratio over the other: above 0 where too many rays are left, and the cutoff is too small.
double miss(const Unshot& rays, const Unshot& target) {
  return std::log(padded(rays) / double(rays.shot)) - std::log(padded(target) / double(target.shot));
}

double standard_error(const Unshot& rays, const Unshot& target) {
  return std::sqrt(1 / padded(rays) + 1 / padded(target));
}

/// A cutoff, and the logarithms of it and of what it misses by.
struct Try {
  double cutoff, log_cutoff, miss;
};

/// Where the logarithm of the ratio, taken as linear in that of the cutoff, is the target's; well inside, since the
/// ratio has steps where many paths have the same attenuation.
double between(const Try& low, const Try& high) {
  const double t = std::clamp(low.miss / (low.miss - high.miss), 0.1, 0.9);
  return std::exp(std::lerp(low.log_cutoff, high.log_cutoff, t));
}

/// What has been tried: the last cutoffs that were too small and too large.
class Bracket {
 public:
  void add(double cutoff, double miss) { (miss > 0 ? low_ : high_) = Try{cutoff, std::log(cutoff), miss}; }

  /// The cutoff to try next; nothing where there is none left.
  std::optional<double> next() const {
    if (low_ && high_) return between(*low_, *high_);
    const double farther = low_ ? low_->cutoff * kStep : high_->cutoff / kStep;
    if (farther >= kLargest * kStep || farther <= kSmallest / kStep) return {};
    return std::clamp(farther, kSmallest, kLargest);
  }

 private:
  std::optional<Try> low_, high_;
};

}  // namespace

Unshot unshot_after(const PathEnds& ends, size_t events) {
  Unshot rays{ends.alive_after(events), 0};
  for (size_t i = 0; i < events; ++i) rays.shot += ends.alive_after(i);
  return rays;
}

size_t depth_of_trees(const PathEnds& ends) {
  size_t events = 1;
  while (events < PathEnds::kDepths - 1 && unshot_after(ends, events).ratio() >= kUnshotRatio) ++events;
  return events;
}

CutoffFit fit_cutoff(const Unshot& target, const std::function<Unshot(double)>& rays_at) {
  CutoffFit best{};
  double smallest_miss = INFINITY;
  Bracket bracket;
  std::optional<double> cutoff = kPaperCutoff;
  for (int i = 0; i < kMostTries && cutoff && !best.equal; ++i) {
    const Unshot rays = rays_at(*cutoff);
    const double missed = miss(rays, target);
    if (std::abs(missed) < smallest_miss) {
      smallest_miss = std::abs(missed);
      best = {*cutoff, rays, smallest_miss <= standard_error(rays, target)};
    }
    bracket.add(*cutoff, missed);
    cutoff = bracket.next();
  }
  return best;
}

}  // namespace frond::compare
