#include <fmt/format.h>

#include <limits>

#include "core/error.h"
#include "report/bench_report.h"

namespace frond {
namespace {

constexpr size_t kMostMarks = 6, kMostRows = 12;
constexpr const char* kColor = "#0072b2";

/// Returns a time with the unit that keeps it short.
std::string time_text(double ns) {
  constexpr std::array kUnits{"ns", "µs", "ms", "s"};
  size_t unit = 0;
  for (; unit + 1 < kUnits.size() && ns >= 999.5; ++unit) ns /= 1000;
  return fmt::format("{:g} {}", ns < 9.95 ? std::round(10 * ns) / 10 : std::round(ns), kUnits[unit]);
}

/// CPU time in ns to a standard error of 1 %, at least the time of one sample; NaN if nothing is scattered.
struct TimeToPercent {
  double ns = NAN, standard_error = 0;
};

TimeToPercent time_of(const BenchMeasurement& r, const Worth& worth) {
  const Estimate& hit = r.time(BsdfCall::hit);
  const double ns = 1e3 * us_to_percent(worth, worth.variance.mean, hit);
  if (!std::isfinite(ns)) return {};
  if (ns <= hit.mean) return {hit.mean, hit.standard_error()};
  return {ns, ns * std::hypot(hit.standard_error() / hit.mean, worth.variance.standard_error() / worth.variance.mean)};
}

/// The measurements of one material under one light, in a row at the height y.
void add_row(Panel& panel, const std::vector<const BenchMeasurement*>& row, Worth SampleWorth::*worth, double y,
             const std::vector<double>& angles) {
  constexpr double kAbove = 0.30, kBelow = 0.34;  // of texts, in rows
  double logs = 0, count = 0;
  for (const BenchMeasurement* r : row) {
    const auto [ns, error] = time_of(*r, r->worth.*worth);
    if (std::isnan(ns)) continue;
    logs += std::log(ns), ++count;
    panel.series.push_back(line("", kColor, 2, Dash::solid, {{ns - error, y}, {ns + error, y}}));
    panel.series.push_back(marks("", kColor, series_mark(index_of(angles, r->theta_deg)), 5, {{ns, y}}));
    if (row.size() > 1) continue;
    panel.series.push_back({"", "", 0, {}, Mark::none, 0, {{ns, y - kBelow}}, time_text(ns)});
  }
  const Range& x = panel.x.range;
  const double at = count > 0 ? std::exp(logs / count) : std::sqrt(x.low * x.high);
  const std::string name = row[0]->material + (count > 0 ? "" : ": nothing is scattered");
  panel.series.push_back({"", "", 0, {}, Mark::none, 0, {{at, y + kAbove}}, name});
}

}  // namespace

double us_to_percent(const Worth& worth, double variance, const Estimate& time_ns) {
  constexpr double kPercent = 0.01;
  if (worth.mean.mean == 0) return std::numeric_limits<double>::infinity();
  const double error = kPercent * worth.mean.mean;
  return time_ns.mean * 1e-3 * variance / (error * error);
}

void check_bench_chart(size_t materials, size_t angles) {
  if (materials > kMostRows)
    fail({}, "--plot: {} materials are more than the {} rows of a chart", materials, kMostRows);
  if (angles > kMostMarks) fail({}, "--plot: {} angles are more than the {} distinguishable marks", angles, kMostMarks);
}

Chart bench_chart(const std::vector<BenchMeasurement>& measurements) {
  const int lanes = std::ranges::max(measurements, {}, &BenchMeasurement::lanes).lanes;
  const auto materials = distinct(measurements, &BenchMeasurement::material);
  const auto angles = distinct(measurements, &BenchMeasurement::theta_deg);
  check_bench_chart(materials.size(), angles.size());
  const double rows = double(materials.size());
  const std::string per = fmt::format("{} wavelength{}", lanes, lanes == 1 ? "" : "s");
  Chart chart{2};
  chart.title = fmt::format("CPU time to a standard error of 1 %, {}{}", per,
                            angles.size() == 1 ? fmt::format(", at {:g}° from the normal", angles[0]) : "");
  for (const auto worth : {&SampleWorth::sky, &SampleWorth::sun}) {
    Range x;
    for (const BenchMeasurement& r : measurements)
      if (r.lanes == lanes) x.include(time_of(r, r.worth.*worth).ns);
    if (x.is_empty()) x = {1, 1};
    const double margin = std::max(3.0, std::cbrt(x.high / x.low));  // for the names
    x = {x.low / margin, x.high * margin};
    std::vector<Tick> ticks;
    for (double ns = 1; ns <= x.high; ns *= 10)
      if (ns >= x.low) ticks.push_back({ns, time_text(ns)});
    if (ticks.size() > 5) std::erase_if(ticks, [](const Tick& t) { return std::lround(std::log10(t.value)) % 3 != 0; });
    Panel& panel = chart.panels.emplace_back(
        Panel{400, 84 + 56 * rows, worth == &SampleWorth::sky ? "under an overcast sky" : "under the sun",
              Axis{"", x, true, 0, ticks}, Axis{"", {-0.6, rows - 0.4}, false, 0, {{-0.6, ""}}}});
    for (size_t m = 0; m < materials.size(); ++m) {
      std::vector<const BenchMeasurement*> row;
      for (const BenchMeasurement& r : measurements)
        if (r.lanes == lanes && r.material == materials[m]) row.push_back(&r);
      add_row(panel, row, worth, rows - 1 - double(m), angles);
    }
  }
  if (angles.size() > 1)
    for (size_t a = 0; a < angles.size(); ++a)
      chart.panels[0].series.push_back(
          marks(fmt::format("{:g}° from the normal", angles[a]), kColor, series_mark(a), 5));
  return chart;
}

}  // namespace frond
