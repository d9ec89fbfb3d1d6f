#include "study/compare/speed_up.h"

#include <algorithm>

namespace frond::compare {
namespace {

/// Returns the effort until every channel meets its own target.
std::optional<Effort> until_all(const CandidateResult& s, const std::array<double, 3>& target) {
  Effort all{0, 0, true};
  for (size_t c = 0; c < 3; ++c) {
    const auto effort = s.convergence(kAll, kFirst + c).until_rms(target[c]);
    if (!effort) return {};
    all.measured = all.measured && effort->measured;
    all.samples = std::max(all.samples, effort->samples);
    all.seconds = std::max(all.seconds, effort->seconds);
  }
  return all;
}

Ratio ratio(const std::optional<Effort>& baseline, const std::optional<Effort>& candidate) {
  if (!candidate) return {Ratio::Kind::not_reached};
  if (!baseline) return {Ratio::Kind::baseline_not_there};
  return {baseline->measured && candidate->measured ? Ratio::Kind::measured : Ratio::Kind::extrapolated,
          baseline->seconds / candidate->seconds};
}

std::optional<Ratio> at_bias(const CandidateResult& baseline, const CandidateResult& candidate) {
  const Convergence own = candidate.convergence(kAll);
  if (!own.until_plateau()) return {};
  const double rms = 1.5 * own.bias().root();
  return ratio(baseline.convergence(kAll).until_rms(rms), own.until_rms(rms));
}

}  // namespace

SpeedUps speed_ups(const Comparison& comparison, size_t index) {
  const CandidateResult &baseline = comparison.candidates.front(), &candidate = comparison.candidates[index];
  const CandidateRun &b = baseline.runs.back(), &c = candidate.runs.back();
  SpeedUps s{};
  s.equal_samples = b.cost.cpu_seconds / c.cost.cpu_seconds;
  const double noise_ratio = b.errors[kAll][kTogether].noise.value / c.errors[kAll][kTogether].noise.value;
  s.equal_noise = s.equal_samples * noise_ratio;
  if (baseline.paper && candidate.paper)
    s.paper = baseline.paper->cpu_seconds_per_sample / candidate.paper->cpu_seconds_per_sample;
  if (const auto& target = comparison.request.target)
    s.equal_error = ratio(until_all(baseline, *target), until_all(candidate, *target));
  s.equal_error_at_bias = at_bias(baseline, candidate);
  return s;
}

}  // namespace frond::compare
