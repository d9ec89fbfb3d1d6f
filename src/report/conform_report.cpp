#include "report/conform_report.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/messages/counted.h"

namespace frond {
namespace {

/// Returns the verdict on one law.
std::string_view verdict(const LawSummary& law) {
  if (law.tests == 0) return "untested";
  return law.failures == 0 ? "holds" : "BROKEN";
}

std::string tests_text(const LawSummary& law) {
  if (law.tests == 0) return "";
  const std::string tests = counted(law.tests, "test");
  return law.failures == 0 ? tests : fmt::format("{} of {}", law.failures, tests);
}

/// Returns the p-value of a statistical law. For other laws the verdict says the same.
std::string p_text(const LawSummary& law) {
  return law.worst && law.worst->statistical ? fmt::format("{:.2g}", law.worst->p_value) : "";
}

/// Returns a number for a sentence: three digits.
std::string number(double v) { return std::isfinite(v) ? fmt::format("{:.3g}", v) : "none"; }

/// Returns a number that differs from 1 by little: three digits of the difference.
std::string number_above_one(double v) {
  return v < 2 ? fmt::format("{:.{}f}", v, std::clamp(2 - int(std::floor(std::log10(std::abs(v - 1)))), 2, 4))
               : number(v);
}

/// Returns where a finding was measured: parameters, wavelength, angle.
std::string place_text(const Finding& f) {
  std::string text = f.parameters;
  if (std::isfinite(f.wavelength_nm)) text += fmt::format(", {:g} nm", f.wavelength_nm);
  if (std::isfinite(f.theta_deg))
    text += fmt::format(", wo at {:g} deg on the {}", f.theta_deg < 90 ? f.theta_deg : 180 - f.theta_deg,
                        f.theta_deg < 90 ? "front" : "back");
  return text;
}

/// Returns the largest directional albedo, where it was found, and the excess that would have been found there.
std::string energy_text(const LawSummary& law, double factor) {
  constexpr double kNegligible = 1e-6;  // a standard error of rounding
  const Measure& m = law.largest->measure;
  std::string text = fmt::format("      directional albedo: at most {:.6g}", m.value);
  if (!(m.standard_error <= kNegligible * m.value)) text += fmt::format(" +- {:.2g}", m.standard_error);
  text += fmt::format(" ({})\n", place_text(*law.largest));
  if (m.value == 0) return text + "      nothing is scattered\n";
  text += fmt::format("      detectable: an excess over 1 of {} there", number(m.detectable));
  if (law.failures == 0 && std::isfinite(factor))
    text += fmt::format("; f too large everywhere by a factor of {}", number_above_one(factor));
  return text + '\n';
}

/// Returns the largest value that a law has measured, and the smallest error that it would have found.
std::string power_text(const LawSummary& law, double factor) {
  if (!law.largest) return "";
  if (law.law.law == Law::energy) return energy_text(law, factor);
  const Measure& m = law.largest->measure;
  std::string text = fmt::format("      {}: at most {:.2g}; detectable: {}", m.quantity, m.value, number(m.detectable));
  if (number(law.least_detectable) != number(m.detectable))
    text += fmt::format(" there, {} at best", number(law.least_detectable));
  return text + '\n';
}

/// Returns the findings that fail, for a broken law.
std::vector<const Finding*> failures_of(const ConformReport& report, Law law) {
  std::vector<const Finding*> failures;
  for (const Finding& f : report.findings)
    if (f.law == law && !f.passed) failures.push_back(&f);
  std::ranges::stable_sort(failures, {}, &Finding::p_value);
  return failures;
}

/// Lists a few failures; tables contain all.
std::string failures_text(const ConformReport& report, Law law) {
  constexpr size_t kShown = 3;
  const auto failures = failures_of(report, law);
  std::string text;
  for (const Finding* f : std::span(failures).first(std::min(failures.size(), kShown))) {
    text += fmt::format("      {}\n        {}", f->where, f->message);
    text += f->statistical ? fmt::format(" (p = {:.2g})\n", f->p_value) : "\n";
  }
  if (failures.size() > kShown) text += fmt::format("      and {} more\n", failures.size() - kShown);
  return text;
}

std::string broken_text(const ConformReport& report) {
  std::vector<std::string_view> names;
  for (const Law law : broken_laws(report.findings)) names.push_back(law_name(law));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Whether the material could be created for at least one set of parameters.
bool was_created(const ConformReport& report) {
  return std::ranges::any_of(report.findings, [](const Finding& f) { return f.law != Law::parameters; });
}

/// Returns which sets of parameters the verdict is about, without a verb.
std::string scope_text(const ConformReport& r) {
  const TestedParameters& p = r.parameters;
  const std::string given = p.are_defaults ? "the defaults" : "the given parameters";
  if (p.given_only) return given + " only";
  if (p.varied.empty())
    return fmt::format("{} only: there is no {}parameter with a range", given, p.are_defaults ? "" : "other ");
  constexpr size_t kMostNamed = 6;
  return fmt::format("{} and {} of {}", given, p.are_swept ? "over the ranges" : "at the ends of the ranges",
                     p.varied.size() > kMostNamed ? counted(p.varied.size(), "parameter")
                                                  : fmt::format("{}", fmt::join(p.varied, ", ")));
}

/// Returns what was not tested.
std::string untested_text(const TestedParameters& p) {
  std::string text;
  if (!p.unvaried.empty()) text += fmt::format("Not varied: {}.\n", fmt::join(p.unvaried, ", "));
  if (!p.refused.empty())
    text += fmt::format("{} {} refused, the first with {}\n",
                        counted(p.refused.size(), "set of parameters", "sets of parameters"),
                        p.refused.size() == 1 ? "is" : "are", p.refused.front());
  return text;
}

std::string samples_text(const ConformReport& r) {
  const std::string at_given = fmt::format("{} samples for each direction", r.effort.samples);
  if (r.parameters.sets == 1 || r.parameters.samples_at_ends == r.effort.samples) return at_given;
  return fmt::format("{}, {} at the ends of ranges", at_given, r.parameters.samples_at_ends);
}

}  // namespace

bool ConformReport::all_hold() const { return std::ranges::all_of(findings, &Finding::passed); }

std::string conform_text(const ConformReport& r) {
  std::string text = fmt::format(
      "{}\n{}; {} nm; wo at {} deg from the normal, front and back\n{}; seed {}\n"
      "{}. If every law holds, the probability that any is reported as broken is {:.2g}: a test fails below p = "
      "{:.2g}.\n"
      "An error of the size called detectable is found with a probability of {:.0f} %.\n\n",
      r.material, counted(r.parameters.sets, "set of parameters", "sets of parameters"),
      fmt::join(r.wavelengths_nm, ", "), fmt::join(r.effort.angles_deg, ", "), samples_text(r), r.effort.seed,
      counted(r.findings.size(), "test"), r.effort.false_alarm_rate, r.level, 100 * kPower);
  if (r.all_hold() && !was_created(r)) text += "The surface is invisible: it has no BSDF to test.\n\n";
  const double factor = detectable_factor(r.findings);
  text += fmt::format("  {:<9}  {:<13}  {:<16}  {:<8}  {}\n", "", "law", "", "worst p", "");
  for (const LawSummary& law : summarise(r.findings)) {
    text += fmt::format("  {:<9}  {:<13}  {:<16}  {:<8}  {}\n", verdict(law), law.law.name, tests_text(law),
                        p_text(law), law.law.text);
    text += power_text(law, factor) + failures_text(r, law.law.law);
  }
  return text + '\n' + conform_verdict(r) + '\n' + untested_text(r.parameters);
}

std::string conform_verdict(const ConformReport& r) {
  if (!r.all_hold()) return "Broken: " + broken_text(r) + ".";
  if (!was_created(r)) return "Only the law of parameters was tested; it holds.";
  return fmt::format("No law was found broken, at {}.", scope_text(r));
}

std::vector<Fact> conform_facts(const ConformReport& r) {
  return {{"frond", std::string("frond " FROND_VERSION)},
          {"material", r.material},
          {"wavelengths_nm", r.wavelengths_nm},
          {"angles_deg", r.effort.angles_deg},
          {"samples", double(r.effort.samples)},
          {"samples_at_ends", double(r.parameters.samples_at_ends)},
          {"seed", double(r.effort.seed)},
          {"false_alarm_rate", r.effort.false_alarm_rate},
          {"excess", r.effort.excess},
          {"level", r.level},
          {"power", kPower},
          {"parameter_sets", double(r.parameters.sets)},
          {"varied", fmt::format("{}", fmt::join(r.parameters.varied, ", "))},
          {"unvaried", fmt::format("{}", fmt::join(r.parameters.unvaried, ", "))},
          {"refused", fmt::format("{}", fmt::join(r.parameters.refused, "\n"))},
          {"detectable_factor", detectable_factor(r.findings)},
          {"verdict", conform_verdict(r)},
          {"all_hold", r.all_hold()}};
}

std::vector<Table> conform_tables(const ConformReport& r) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Table laws{"laws"}, findings{"findings"};
  for (const LawSummary& law : summarise(r.findings)) {
    laws.add("law", std::string(law.law.name));
    laws.add("verdict", std::string(law.failures > 0 ? "broken" : verdict(law)));
    laws.add("tests", law.tests);
    laws.add("failures", law.failures);
    laws.add("worst_p", law.worst && law.worst->statistical ? law.worst->p_value : kNone);
    const Finding none{.law = law.law.law, .where = {}, .message = {}};
    const Finding& largest = law.largest ? *law.largest : none;
    laws.add("quantity", std::string(largest.measure.quantity));
    laws.add("largest", largest.measure.value, largest.measure.standard_error);
    laws.add("largest_parameters", largest.parameters);
    laws.add("largest_wavelength_nm", largest.wavelength_nm);
    laws.add("largest_theta_deg", largest.theta_deg);
    laws.add("detectable", largest.measure.detectable);
    laws.add("detectable_least", law.least_detectable);
    laws.add("says", std::string(law.law.text));
  }
  for (const Finding& f : r.findings) {
    findings.add("law", std::string(law_name(f.law)));
    findings.add_flag("holds", f.passed);
    findings.add("where", f.where);
    findings.add("message", f.message);
    findings.add("p", f.statistical ? f.p_value : kNone);
    findings.add("parameters", f.parameters);
    findings.add("wavelength_nm", f.wavelength_nm);
    findings.add("theta_deg", f.theta_deg);
    findings.add("quantity", std::string(f.measure.quantity));
    findings.add("value", f.measure.value, f.measure.standard_error);
    findings.add("detectable", f.measure.detectable);
  }
  return {laws, findings};
}

const Finding* finding_to_draw(const ConformReport& report) {
  const Finding* worst = nullptr;
  for (const Finding& f : report.findings)
    if (f.map && (!worst || std::pair(f.passed, f.p_value) < std::pair(worst->passed, worst->p_value))) worst = &f;
  return worst;
}

}  // namespace frond
