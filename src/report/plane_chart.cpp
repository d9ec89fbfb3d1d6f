#include <fmt/format.h>

#include "core/error.h"
#include "report/patch_charts.h"

namespace frond {
namespace {

constexpr size_t kMostAngles = 6, kMostMaterials = 4;
constexpr std::array kMaterialMarks{Mark::disk, Mark::ring, Mark::square, Mark::open_square};  // by material

/// Returns f of the patches in the plane of incidence, with standard errors. The angle is from the normal of that side,
/// negative on the light's side.
std::vector<ChartPoint> plane_points(const GoniophotometerMeasurement& r, bool reflected) {
  std::vector<ChartPoint> points;
  for (const int column : {0, r.sphere.phis() / 2})
    for (int row = 0; row < r.sphere.thetas(); ++row) {
      const Patch p = r.sphere.patch(row, column);
      const double from_normal = std::min(p.theta_deg(), 180 - p.theta_deg());
      const Estimate f = r.f(r.sphere.index(row, column));
      if (r.is_reflected(p) == reflected)
        points.push_back(with_error(column == 0 ? -from_normal : from_normal, f.mean, f.standard_error()));
    }
  std::ranges::sort(points, {}, &ChartPoint::x);
  return points;
}

std::string_view side_of(const GoniophotometerMeasurement& r, bool reflected) {
  if (!r.fluorescence.empty()) return reflected ? "Lit side" : "Other side";
  return reflected ? "Reflected" : "Transmitted";
}

/// Returns a panel with the vertical lines of one angle of incidence. y extends to the largest f of all measurements.
Panel empty_panel(const std::vector<LabelledPatches>& measurements, double theta_deg, bool reflected) {
  double top = 0;
  for (const auto& [material, r] : measurements)
    for (const ChartPoint& p : plane_points(r, reflected)) top = std::max(top, 1.08 * p.y);
  const double mirror = std::min(theta_deg, 180 - theta_deg), high = top > 0 ? top : 1;
  const std::string title =
      fmt::format("{}, light at θ = {:g}°", side_of(measurements[0].measurement, reflected), theta_deg);
  const Axis x{"angle from the normal (°), light’s side negative", {-90, 90}, false, 30},
      y{name_of_f(measurements[0].measurement, reflected ? "BRDF" : "BTDF"), {0, high}};
  Panel panel{420, 320, title, x, y};
  panel.series.push_back(line("", "#808080", 1.5, Dash::solid, {{mirror, 0}, {mirror, high}}));
  if (reflected) panel.series.push_back(line("", "#808080", 1.5, Dash::dotted, {{-mirror, 0}, {-mirror, high}}));
  return panel;
}

}  // namespace

void check_plane_chart(const MeasurementCounts& c, const DetectorSphere& sphere) {
  if (sphere.phis() % 2 != 0)
    fail({}, "--plot: with {} patches in phi no patch is centred opposite the light; an even number is needed",
         sphere.phis());
  if (c.wavelengths > kSeriesColors.size() || c.materials > kMostMaterials || c.angles > kMostAngles)
    fail({}, "--plot holds {} wavelengths, {} materials and {} angles at most; {}, {} and {} were given",
         kSeriesColors.size(), kMostMaterials, kMostAngles, c.wavelengths, c.materials, c.angles);
}

Chart plane_chart(const std::vector<LabelledPatches>& measurements) {
  const auto materials = distinct(measurements, &LabelledPatches::material);
  const auto angles = distinct(measurements, [](const auto& r) { return r.measurement.beam.theta_deg; });
  const auto lights = distinct(measurements, [](const auto& r) { return label_of(r.measurement.beam); });
  const bool some_integrated =
      std::ranges::any_of(measurements, [](const auto& r) { return r.measurement.is_integrated(); });
  // An integrated f is a line; a measured f of the same material is drawn as points.
  const auto series = [&](const LabelledPatches& r, const std::string& label, const std::string& color) -> Series {
    const size_t m = index_of(materials, r.material);
    const bool exact = r.measurement.is_integrated();
    return {label, color, exact || !some_integrated ? 1.5 : 0, Dash(m), exact ? Mark::none : kMaterialMarks[m], 2.5};
  };
  Chart chart{angles.size()};
  for (const bool reflected : {true, false})
    for (const double theta_deg : angles) {
      Panel& panel = chart.panels.emplace_back(empty_panel(measurements, theta_deg, reflected));
      if (angles.size() == 1) panel.width *= 2;
      for (const LabelledPatches& r : measurements) {
        if (r.measurement.beam.theta_deg != theta_deg) continue;
        panel.series.push_back(series(r, "", kSeriesColors[index_of(lights, label_of(r.measurement.beam))]));
        panel.series.back().points = plane_points(r.measurement, reflected);
      }
    }
  auto& legend = chart.panels[0].series;
  legend[0].label = "mirror direction, or straight on", legend[1].label = "toward the light";
  for (size_t i = 0; i < lights.size(); ++i) legend.push_back(line(lights[i], kSeriesColors[i], 2));
  for (const std::string& m : materials)
    legend.push_back(series(*std::ranges::find(measurements, m, &LabelledPatches::material), m, "#404040"));
  return chart;
}

}  // namespace frond
