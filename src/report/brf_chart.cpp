#include "report/brf_chart.h"

#include <fmt/format.h>

#include <numbers>

#include "core/error.h"
#include "report/polar_map.h"
#include "spectra/wavelengths/band_label.h"

namespace frond {

Chart brf_plane_chart(const BrfMeasurement& r) {
  constexpr double kLogarithmic = 8;  // bands whose values differ by a larger factor need a logarithmic scale
  const auto [least, most] = std::ranges::minmax(r.values, {}, &MeanError::mean);
  const bool logarithmic = least.mean > 0 && most.mean / least.mean > kLogarithmic;
  const Range values = logarithmic ? Range{least.mean, most.mean}.widened() : Range{0, 1.08 * most.mean};
  Panel panel{900,
              520,
              "",
              {"zenith angle of the view (degrees)", {}, false, 15},
              {std::string(r.quantity), values, logarithmic}};
  auto planes = distinct(r.views, &ViewDirection::azimuth_deg);
  std::ranges::sort(planes);
  for (const double azimuth : planes)
    for (size_t band = 0; band < r.bands.size(); ++band) {
      const char* color = kSeriesColors[panel.series.size() % kSeriesColors.size()];
      Series s{label_of(r.bands[band]), color, 2, {}, Mark::disk, 2};
      if (planes.size() > 1) s.label += fmt::format(", {:g}°", azimuth);
      for (size_t i = 0; i < r.views.size(); ++i)
        if (r.views[i].azimuth_deg == azimuth)
          s.points.push_back(with_error(r.views[i].zenith_deg, r.at(i, band).mean, r.at(i, band).standard_error));
      panel.series.push_back(std::move(s));
    }
  return {1, {panel}};
}

Chart brf_hemisphere_chart(const BrfMeasurement& r) {
  constexpr size_t kMost = 12;
  const size_t bands = r.bands.size();
  if (bands > kMost) fail({}, "--plot draws at most {} maps, {} bands were given", kMost, bands);
  const auto zeniths = distinct(r.views, &ViewDirection::zenith_deg);
  const double ring = 1.0 / double(zeniths.size());
  Chart chart{2 * std::min<size_t>(bands, 3)};
  for (size_t band = 0; band < bands; ++band) {
    ColorScale scale;
    for (size_t i = 0; i < r.views.size(); ++i) scale.axis.range.include(r.at(i, band).mean);
    const std::string title = fmt::format("{} {}", r.quantity, place_of(r.bands[band]));
    const PolarMap map{chart.panels.emplace_back(disk_panel(340, title))};
    for (size_t i = 0; i < r.views.size(); ++i) {
      const auto& [zenith, azimuth] = r.views[i];
      const double half = std::numbers::pi / double(std::ranges::count(r.views, zenith, &ViewDirection::zenith_deg)),
                   middle = azimuth * std::numbers::pi / 180, radius = zenith / 90;
      map.add_patch({std::max(0., radius - ring / 2), radius + ring / 2}, {middle - half, middle + half},
                    scale.color(r.at(i, band).mean));
    }
    map.add_circles();
    chart.panels.push_back(scale.panel(380));
  }
  return chart;
}

}  // namespace frond
