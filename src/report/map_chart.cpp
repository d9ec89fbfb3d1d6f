#include <fmt/format.h>

#include <numbers>

#include "core/error.h"
#include "core/math/vec.h"
#include "report/patch_charts.h"
#include "report/polar_map.h"

namespace frond {
namespace {

constexpr size_t kMostMaps = 12;
constexpr size_t kMostPatches = 100'000;

/// Returns the scale of all values above 0. A logarithmic scale spans at least a decade, so that it has a labelled
/// tick.
ColorScale scale_of(const std::vector<LabelledPatches>& measurements, bool logarithmic) {
  constexpr double kLeastSpan = 11;
  Range range;
  for (const auto& [material, r] : measurements)
    for (size_t i = 0; i < r.sphere.size(); ++i)
      if (const double f = r.f(i).mean; f > 0) range.include(f);
  if (range.is_empty()) range = {1e-6, 1};
  return {{name_of_f(measurements[0].measurement, "f"),
           {logarithmic ? std::min(range.low, range.high / kLeastSpan) : 0, range.high},
           logarithmic}};
}

/// Draws a hemisphere seen from the light's side, with the light from the left. If the back is lit, azimuths are
/// mirrored.
void add_patches(const PolarMap& map, const ColorScale& scale, const GoniophotometerMeasurement& r, bool reflected) {
  const double handed = r.beam.theta_deg <= 90 ? kDegree : -kDegree;
  for (size_t i = 0; i < r.sphere.size(); ++i) {
    const Patch p = r.sphere.patch(i);
    if (r.is_reflected(p) != reflected) continue;
    const Range radius{std::min(p.theta_min_deg, 180 - p.theta_max_deg) / 90,
                       std::min(p.theta_max_deg, 180 - p.theta_min_deg) / 90};
    const auto [from, to] = std::minmax({handed * p.phi_min_deg, handed * p.phi_max_deg});
    map.add_patch(radius, {std::numbers::pi + from, std::numbers::pi + to}, scale.color(r.f(i).mean));
  }
}

}  // namespace

void check_map_chart(const MeasurementCounts& c, const DetectorSphere& sphere) {
  const size_t measurements = c.materials * c.angles * c.wavelengths;
  if (measurements > kMostMaps)
    fail({}, "--map draws {} measurements at most, {} were given ({} materials, {} angles, {} wavelengths)", kMostMaps,
         measurements, c.materials, c.angles, c.wavelengths);
  if (sphere.size() > kMostPatches)
    fail({}, "--map draws {} patches at most, there are {} x {}", kMostPatches, sphere.thetas(), sphere.phis());
}

Chart map_chart(const std::vector<LabelledPatches>& measurements, bool logarithmic) {
  const ColorScale scale = scale_of(measurements, logarithmic);
  Chart chart{3};
  for (const auto& [material, r] : measurements) {
    const double theta_deg = r.beam.theta_deg;
    const double radius = std::min(theta_deg, 180 - theta_deg) / 90;
    const std::string light = fmt::format("{}, seen through: light at {:g}°, {}",
                                          r.fluorescence.empty() ? "BTDF" : "other side", theta_deg, label_of(r.beam));
    for (const bool reflected : {true, false}) {
      const bool labelled = chart.panels.empty();
      const PolarMap map{chart.panels.emplace_back(
          disk_panel(400, reflected ? (r.fluorescence.empty() ? "BRDF: " : "lit side: ") + material : light))};
      add_patches(map, scale, r, reflected);
      map.add_circles();
      if (reflected) map.add_mark({-radius, 0}, Mark::star, labelled ? "direction of the light" : "");
      map.add_mark({radius, 0}, Mark::cross, labelled ? "mirror direction, or straight on" : "");
    }
    chart.panels.push_back(scale.panel(440));
  }
  return chart;
}

}  // namespace frond
