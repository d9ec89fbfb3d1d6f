#include "instruments/conformance/conformance.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "instruments/conformance/examination.h"
#include "instruments/errors/statistics.h"

namespace frond {

std::string_view law_name(Law law) { return kLaws[static_cast<size_t>(law)].name; }

Findings examine(const Bsdf& bsdf, const SampledWavelengths& lambda, const Claims& claims,
                 const ExaminationEffort& effort, const std::string& where) {
  Findings findings;
  for (const double angle_deg : effort.angles_deg)
    for (const int side : {1, -1}) {
      const double cos_theta = side * std::cos(angle_deg * std::numbers::pi / 180);
      const double phi = 0.4 + 0.03 * angle_deg;  // off the axes, where errors of azimuth would not show
      ExaminationEffort own = effort;
      own.seed = hash_key(effort.seed, static_cast<uint64_t>(angle_deg), static_cast<uint64_t>(side + 1));
      const size_t first = findings.size();
      const std::string here = fmt::format("{}, wo at {} deg on the {}", where, angle_deg, side > 0 ? "front" : "back");
      run_guarded(here, findings, [&] {
        const Examination s(bsdf, lambda, sphere_direction(cos_theta, phi), own, here);
        check_sampling(s, findings);
        check_normalisation(s, findings);
        check_energy(s, claims, own.seed, findings);
        check_unbiasedness(s, findings);
        check_streams(s, own.seed, findings);
        check_agreement(s, findings);
        check_flags(s, findings);
        check_lanes(s, findings);
        check_coverage(s, findings);
        check_values(s, findings);
      });
      for (Finding& f : std::span(findings).subspan(first)) f.theta_deg = side > 0 ? angle_deg : 180 - angle_deg;
    }
  run_guarded(where, findings, [&] { check_edge_cases(bsdf, where, effort.seed, findings); });
  if (claims.reciprocal) run_guarded(where, findings, [&] { check_reciprocity(bsdf, where, effort, findings); });
  return findings;
}

double apply_false_alarm_rate(Findings& findings, double false_alarm_rate) {
  size_t tests = 0;
  for (const Finding& f : findings) tests += f.statistical ? 1 : 0;
  // Exact tests have p = 0 or 1 and raise no false alarms, so only statistical ones share the rate.
  const double level = sidak_level(false_alarm_rate, tests);
  for (Finding& f : findings) {
    f.passed = f.p_value >= level;
    if (f.measure.detectable_at) f.measure.detectable = f.measure.detectable_at(level);
  }
  return level;
}

std::vector<LawSummary> summarise(std::span<const Finding> findings) {
  std::vector<LawSummary> laws;
  for (const LawInfo& law : kLaws) laws.push_back({law});
  for (const Finding& f : findings) {
    LawSummary& law = laws[static_cast<size_t>(f.law)];
    ++law.tests;
    law.failures += f.passed ? 0 : 1;
    if (!law.worst || f.p_value < law.worst->p_value) law.worst = &f;
    if (f.measure.quantity.empty()) continue;
    if (!law.largest || !(f.measure.value <= law.largest->measure.value)) law.largest = &f;  // NaN is the largest
    law.least_detectable = std::fmin(law.least_detectable, f.measure.detectable);
  }
  return laws;
}

double detectable_factor(std::span<const Finding> findings) {
  double least = std::numeric_limits<double>::infinity();
  for (const Finding& f : findings)
    if (f.law == Law::energy && f.measure.value > 0)
      least = std::fmin(least, (1 + f.measure.detectable) / f.measure.value);
  return least;
}

std::set<Law> broken_laws(std::span<const Finding> findings) {
  std::set<Law> laws;
  for (const Finding& f : findings)
    if (!f.passed) laws.insert(f.law);
  return laws;
}

std::string failures_text(std::span<const Finding> findings) {
  constexpr int kLines = 20;
  std::string text;
  int failures = 0;
  for (const Finding& f : findings)
    if (!f.passed && ++failures <= kLines)
      text += fmt::format("{} [{}] {} (p = {:.2g})\n", law_name(f.law), f.where, f.message, f.p_value);
  if (failures > kLines) text += fmt::format("and {} more\n", failures - kLines);
  return text;
}

}  // namespace frond
