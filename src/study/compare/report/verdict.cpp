#include "study/compare/report/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "instruments/errors/statistics.h"
#include "study/compare/error_unit.h"

namespace frond::compare {
namespace {

constexpr double kRisk = 0.05;

const std::string& label(const Comparison& c, size_t candidate) { return c.candidates[candidate].candidate.label; }

double cost_of(const CandidateCost& offer) {
  return offer.effort ? offer.effort->seconds : std::numeric_limits<double>::infinity();
}

std::string effort_text(const Effort& e) {
  return fmt::format("{:.0f} sample{} per pixel, {} s of CPU{}", std::ceil(e.samples), e.samples > 1 ? "s" : "",
                     figures(e.seconds, 3), e.measured ? "" : " by extrapolation");
}

/// Whether the candidate's cost is within the few per cent by which times of one program vary.
bool is_near_cheapest(const std::vector<CandidateCost>& all, size_t candidate) {
  constexpr double kMargin = 1.05;
  const auto own = std::ranges::find(all, candidate, &CandidateCost::candidate);
  return cost_of(*own) <= kMargin * cost_of(all.front());
}

std::string answer_text(const Comparison& c, double rms) {
  const ErrorUnit unit = c.request.error_unit();
  const double z = simultaneous_z(c);
  const auto all = candidate_costs(c, rms, z);
  const CandidateCost& best = all.front();
  if (!best.effort) {
    const auto most = [z](const CandidateResult& s) { return s.convergence(kAll).bias().root_at(z); };
    const auto least = std::ranges::min_element(c.candidates, {}, most);
    return fmt::format(
        "None of the candidates meets {} of {} with 95 % confidence: the bias of {}, the least, may be up to {}.",
        unit.rms(), unit.in_argument_unit(rms), least->candidate.label, unit.rounded(most(*least)));
  }
  std::string text = fmt::format("{} is enough for {} of {}, with 95 % confidence: {}", label(c, best.candidate),
                                 unit.rms(), unit.in_argument_unit(rms), effort_text(*best.effort));
  for (const CandidateCost& other : all) {
    if (other.candidate == best.candidate) continue;
    text += "; " + label(c, other.candidate);
    text += other.effort  ? fmt::format(" takes {} s", figures(other.effort->seconds, 3))
            : other.never ? " never gets there"
                          : " may not get there: its bias is not known that well";
  }
  return text + '.';
}

std::string overview(const Comparison& c) {
  const ErrorUnit unit = c.request.error_unit();
  std::string text;
  for (const CheapestRange& reign : cheapest_ranges(c)) {
    const CandidateResult& s = c.candidates[reign.candidate];
    const auto effort = s.convergence(kAll).until_rms(reign.rms_to);
    const std::string price = effort ? fmt::format(" ({})", effort_text(*effort)) : "";
    text += text.empty()
                ? fmt::format("{} is the cheapest down to {} of {}{}", s.candidate.label, unit.rms(),
                              unit.rounded(reign.rms_to), price)
                : fmt::format("; from there {} down to {}{}", s.candidate.label, unit.rounded(reign.rms_to), price);
  }
  return text + '.';
}

}  // namespace

std::vector<CandidateCost> candidate_costs(const Comparison& c, double rms, double z) {
  std::vector<CandidateCost> all;
  for (size_t i = 0; i < c.candidates.size(); ++i) {
    const Convergence convergence = c.candidates[i].convergence(kAll);
    all.push_back({i, convergence.until_rms(rms, z), convergence.bias().root_at(-z) > rms});
  }
  std::ranges::stable_sort(all, {}, cost_of);
  return all;
}

double simultaneous_z(const Comparison& c) {
  return normal_upper_quantile(sidak_level(kRisk, 2 * c.candidates.size()));
}

std::vector<CheapestRange> cheapest_ranges(const Comparison& c) {
  double largest = std::numeric_limits<double>::infinity(), smallest = largest;
  for (const CandidateResult& s : c.candidates) {
    largest = std::min(largest, s.runs.front().errors[kAll][kTogether].total.root());
    smallest = std::min(smallest, s.runs.back().errors[kAll][kTogether].total.root());
  }
  std::vector<CheapestRange> result;
  if (!(smallest > 0)) return result;
  constexpr int kSteps = 400;
  for (int i = 0; i <= kSteps; ++i) {
    const double rms = largest * std::pow(smallest / largest, double(i) / kSteps);
    const auto all = candidate_costs(c, rms, 0);
    if (!all.front().effort) break;
    if (result.empty() || !is_near_cheapest(all, result.back().candidate))
      result.push_back({all.front().candidate, rms, rms});
    result.back().rms_to = rms;
  }
  return result;
}

std::string verdict(const Comparison& c) {
  if (c.request.rms.empty()) return overview(c);
  std::string text;
  for (const double rms : c.request.rms) text += (text.empty() ? "" : "\n") + answer_text(c, rms);
  return c.leaf_by_leaf.empty() ? text : text + '\n' + c.leaf_by_leaf;
}

}  // namespace frond::compare
