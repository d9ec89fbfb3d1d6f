#include "report/conform_report.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

namespace frond {
namespace {

/// Returns the verdict on one law.
std::string_view verdict(const LawSummary& law) {
  if (law.tests == 0) return "untested";
  return law.failures == 0 ? "holds" : "BROKEN";
}

std::string counted(size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string tests_text(const LawSummary& law) {
  if (law.tests == 0) return "";
  const std::string tests = counted(static_cast<size_t>(law.tests), "test");
  return law.failures == 0 ? tests : fmt::format("{} of {}", law.failures, tests);
}

/// Returns the p-value of a statistical law. For other laws the verdict says the same.
std::string p_text(const LawSummary& law) {
  return law.worst && law.worst->statistical ? fmt::format("{:.2g}", law.worst->p_value) : "";
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
bool is_there(const ConformReport& report) {
  return std::ranges::any_of(report.findings, [](const Finding& f) { return f.law != Law::parameters; });
}

}  // namespace

bool ConformReport::all_hold() const { return std::ranges::all_of(findings, &Finding::passed); }

std::string conform_text(const ConformReport& r) {
  std::string text = fmt::format(
      "{}\n{} nm; wo at {} deg from the normal, front and back; {} samples each; seed {}\n{}. If every law "
      "holds, "
      "the probability that any is reported as broken is {:.2g}: a test fails below p = {:.2g}.\n\n",
      r.material, fmt::join(r.wavelengths_nm, ", "), fmt::join(r.effort.angles_deg, ", "), r.effort.samples,
      r.effort.seed, counted(r.findings.size(), "test"), r.false_alarm_rate, r.level);
  if (r.all_hold() && !is_there(r)) text += "The surface is invisible: it has no BSDF to test.\n\n";
  text += fmt::format("  {:<9}  {:<13}  {:<16}  {:<8}  {}\n", "", "law", "", "worst p", "");
  for (const LawSummary& law : summarise(r.findings)) {
    text += fmt::format("  {:<9}  {:<13}  {:<16}  {:<8}  {}\n", verdict(law), law.law.name, tests_text(law),
                        p_text(law), law.law.text);
    text += failures_text(r, law.law.law);
  }
  if (!r.all_hold()) return text + "\nBroken: " + broken_text(r) + ".\n";
  return text + (is_there(r) ? "\nAll tested laws hold.\n" : "\nOnly the law of parameters was tested; it holds.\n");
}

std::vector<Fact> conform_facts(const ConformReport& r) {
  return {{"frond", std::string("frond " FROND_VERSION)},
          {"material", r.material},
          {"wavelengths_nm", r.wavelengths_nm},
          {"angles_deg", r.effort.angles_deg},
          {"samples", double(r.effort.samples)},
          {"seed", double(r.effort.seed)},
          {"false_alarm_rate", r.false_alarm_rate},
          {"level", r.level},
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
    laws.add("says", std::string(law.law.text));
  }
  for (const Finding& f : r.findings) {
    findings.add("law", std::string(law_name(f.law)));
    findings.add_flag("holds", f.passed);
    findings.add("where", f.where);
    findings.add("message", f.message);
    findings.add("p", f.statistical ? f.p_value : kNone);
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
