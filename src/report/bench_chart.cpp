#include <fmt/format.h>

#include "core/error.h"
#include "report/bench_report.h"

namespace frond {
namespace {

constexpr size_t kMostAngles = 6;

/// Returns relative variance against time; NaN if the mean is 0.
ChartPoint point_of(const BenchMeasurement& r, const Worth& w) {
  const double square = w.mean.mean * w.mean.mean, variance = w.variance.mean / square;
  return with_error(r.time(BsdfCall::hit).mean, variance > 0 ? variance : NAN, w.variance.standard_error() / square);
}

}  // namespace

void check_bench_chart(size_t materials, size_t angles) {
  if (materials > kSeriesColors.size())
    fail({}, "--plot: {} materials are more than the {} distinguishable colours", materials, kSeriesColors.size());
  if (angles > kMostAngles)
    fail({}, "--plot: {} angles are more than the {} distinguishable marks", angles, kMostAngles);
}

Chart bench_chart(const std::vector<BenchMeasurement>& measurements) {
  const int lanes = std::ranges::max(measurements, {}, &BenchMeasurement::lanes).lanes;
  const auto materials = distinct(measurements, &BenchMeasurement::material);
  const auto angles = distinct(measurements, &BenchMeasurement::theta_deg);
  check_bench_chart(materials.size(), angles.size());
  const std::string time = fmt::format("CPU time of a hit, {} wavelength{} (ns)", lanes, lanes == 1 ? "" : "s");
  Chart chart{2};
  for (const auto worth : {&SampleWorth::sky, &SampleWorth::sun}) {
    Range x, y;
    std::vector<Series> points;
    for (const BenchMeasurement& r : measurements) {
      if (r.lanes != lanes) continue;
      const ChartPoint p = point_of(r, r.worth.*worth);
      x.include(p.x), y.include(p.y);
      const double error = r.time(BsdfCall::hit).standard_error();
      const std::string color = kSeriesColors[place_in(materials, r.material)];
      points.push_back(marks("", color, series_mark(place_in(angles, r.theta_deg)), 3.5, {p}));
      points.push_back(line("", color, 1.2, Dash::solid, {{p.x - error, p.y}, {p.x + error, p.y}}));
    }
    if (y.is_empty()) y = {1, 1};
    x = x.widened(), y = y.widened();
    const std::string title = worth == &SampleWorth::sky ? "under an overcast sky" : "under the sun";
    const Axis variance{"variance of one sample / mean²", y, true};
    Panel& panel = chart.panels.emplace_back(Panel{500, 460, title, {time, x, true}, variance});
    for (double k = std::floor(std::log10(x.low * y.low)); k <= std::ceil(std::log10(x.high * y.high)); ++k) {
      const double product = std::pow(10, k);  // time x variance
      panel.series.push_back(
          line("", "#a0a0a0", 1, Dash::dashed, {{x.low, product / x.low}, {x.high, product / x.high}}));
    }
    std::ranges::move(points, std::back_inserter(panel.series));
  }
  auto& legend = chart.panels[0].series;
  legend[0].label = "time × variance alike";
  for (size_t m = 0; m < materials.size(); ++m)
    legend.push_back(marks(materials[m], kSeriesColors[m], Mark::disk, 3.5));
  for (size_t a = 0; a < angles.size(); ++a)
    legend.push_back(marks(fmt::format("{:g}° from the normal", angles[a]), "#808080", series_mark(a), 3.5));
  return chart;
}

}  // namespace frond
