#include "report/bench_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace frond {
namespace {

/// The readings of one material stand together.
std::vector<std::span<const BenchReading>> by_material(const std::vector<BenchReading>& readings) {
  std::vector<std::span<const BenchReading>> groups;
  for (auto first = readings.begin(); first != readings.end();) {
    const auto last = std::find_if(first, readings.end(), [&](const auto& r) { return r.material != first->material; });
    groups.emplace_back(first, last);
    first = last;
  }
  return groups;
}

/// Of the first angle: the same for all.
std::vector<int> lanes_of(std::span<const BenchReading> group) {
  std::vector<int> lanes;
  for (const BenchReading& r : group)
    if (r.theta_deg == group.front().theta_deg) lanes.push_back(r.lanes);
  return lanes;
}

std::string times_text(std::span<const BenchReading> group) {
  const std::vector<int> lanes = lanes_of(group);
  std::string text = fmt::format("  {:<6}  {:>5}", "call", "theta");
  for (const int n : lanes) text += fmt::format("  {:>18}", fmt::format("{} wavelength{}", n, n == 1 ? "" : "s"));
  text += '\n';
  for (size_t call = 0; call < kBsdfCalls.size(); ++call)
    for (size_t i = 0; i < group.size(); i += lanes.size()) {
      text += fmt::format("  {:<6}  {:>5.4g}", kBsdfCalls[call], group[i].theta_deg);
      for (const BenchReading& r : group.subspan(i, lanes.size()))
        text += fmt::format("  {:>9.1f} +- {:>5.1f}", r.time_ns[call].mean, r.time_ns[call].standard_error());
      text += '\n';
    }
  return text;
}

std::string seconds_text(double seconds) {
  if (!std::isfinite(seconds)) return "-";
  return fmt::format("{:.3g}", seconds * 1e6);
}

std::string worth_text(const Worth& w, const Estimate& time_ns) {
  constexpr double kRounding = 1e-12;  // of floats, in the variance
  const double variance = w.variance.mean < kRounding ? 0 : w.variance.mean;
  return fmt::format("  {:>7.4f} {:>9.3g} {:>7}", w.mean.mean, variance,
                     variance == 0 && w.mean.mean > 0 ? "0" : seconds_text(seconds_to_percent(w, time_ns)));
}

std::string worths_text(std::span<const BenchReading> group) {
  std::string text = fmt::format("  {:>5}  {:>11}", "theta", "wavelengths");
  for (const char* what : {"albedo", "sky", "sun"})
    text += fmt::format("  {:>7} {:>9} {:>7}", what, "variance", "us/1%");
  text += '\n';
  for (const BenchReading& r : group)
    text += fmt::format("  {:>5.4g}  {:>11}{}{}{}\n", r.theta_deg, r.lanes,
                        worth_text(r.worth.albedo, r.time(BsdfCall::sample)),
                        worth_text(r.worth.sky, r.time(BsdfCall::hit)), worth_text(r.worth.sun, r.time(BsdfCall::hit)));
  return text;
}

}  // namespace

double seconds_to_percent(const Worth& worth, const Estimate& time_ns) {
  constexpr double kPercent = 0.01;
  if (worth.mean.mean == 0) return std::numeric_limits<double>::infinity();
  const double error = kPercent * worth.mean.mean;
  return time_ns.mean * 1e-9 * worth.variance.mean / (error * error);
}

std::string bench_text(const std::vector<BenchReading>& readings) {
  std::string text;
  for (const auto group : by_material(readings)) {
    text += fmt::format("{}{}\n  CPU time of a call, ns +- standard error\n", text.empty() ? "" : "\n",
                        group.front().material);
    text += times_text(group);
    text +=
        "  What a sample is worth: one-sample estimates; us/1%: CPU time in microseconds to a standard error of 1 %\n";
    text += worths_text(group);
  }
  return text;
}

}  // namespace frond
