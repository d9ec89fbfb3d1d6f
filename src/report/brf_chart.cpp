#include "report/brf_chart.h"

#include <fmt/format.h>

#include <numbers>
#include <set>

#include "core/error.h"
#include "report/polar_map.h"
#include "spectra/wavelengths/band_label.h"

namespace frond {
namespace {

constexpr size_t kMostPanels = 12;

/// Returns the labels of the bands: wavelengths in whole nanometres if these distinguish the bands.
std::vector<std::string> labels_of(const std::vector<Band>& bands) {
  std::vector<std::string> labels, exact;
  for (const Band& band : bands) {
    exact.push_back(label_of(band));
    labels.push_back(band.name.empty() ? fmt::format("{:.0f} nm", band.nm) : band.name);
  }
  return std::set(labels.begin(), labels.end()).size() == labels.size() ? labels : exact;
}

Range range_of(const BrfMeasurement& r, size_t band) {
  Range range;
  for (size_t i = 0; i < r.views.size(); ++i) range.include(r.at(i, band).mean);
  return range;
}

/// Whether one linear axis from 0 shows all bands: the smallest maximum is not much below the largest.
bool share_an_axis(const BrfMeasurement& r) {
  constexpr double kMost = 3;
  Range tops;
  for (size_t band = 0; band < r.bands.size(); ++band) tops.include(range_of(r, band).high);
  return tops.high <= kMost * tops.low;
}

/// Adds a vertical line at the sun, which the axis of the zenith angle explains.
void add_sun(Panel& panel, const BrfMeasurement& r) {
  if (!r.sun_zenith_deg) return;
  panel.x.label += ", negative: sun’s side";
  Range views;
  for (const ViewDirection& view : r.views) views.include(view.zenith_deg);
  const double at = -*r.sun_zenith_deg, top = panel.y.range.high;
  if (at < views.low || at > views.high) return;
  panel.series.push_back(line("", "#808080", 1, Dash::dashed, {{at, top}, {at, panel.y.range.low}}));
  panel.series.push_back(marks("", "#808080", Mark::none, 0, {{at, top - 0.04 * (top - panel.y.range.low)}}));
  panel.series.back().text = "sun";
}

}  // namespace

Chart brf_plane_chart(const BrfMeasurement& r) {
  auto planes = distinct(r.views, &ViewDirection::azimuth_deg);
  std::ranges::sort(planes);
  const std::vector<std::string> labels = labels_of(r.bands);
  const bool is_one = share_an_axis(r), is_logarithmic = !is_one && r.bands.size() > kMostPanels;
  const bool has_panels = !is_one && !is_logarithmic;
  const auto empty_panel = [&](const std::string& title, const Range& values) {
    const Range y = is_logarithmic ? values.widened() : Range{0, 1.08 * values.high};
    Panel panel{has_panels ? 450. : 900.,
                has_panels ? 320. : 520.,
                title,
                {"view zenith angle (degrees)", {}, false, has_panels ? 30. : 15.},
                {std::string(r.quantity), y, is_logarithmic}};
    add_sun(panel, r);
    return panel;
  };
  Chart chart{has_panels ? size_t{2} : size_t{1}};
  Range all;
  for (const MeanError& value : r.values)
    if (!is_logarithmic || value.mean > 0) all.include(value.mean);
  if (!has_panels) chart.panels.push_back(empty_panel("", all));
  for (size_t band = 0; band < r.bands.size(); ++band) {
    Panel& panel =
        has_panels ? chart.panels.emplace_back(empty_panel(labels[band], range_of(r, band))) : chart.panels[0];
    for (size_t plane = 0; plane < planes.size(); ++plane) {
      const size_t color = has_panels ? plane : band * planes.size() + plane;
      Series s{"", kSeriesColors[(color + 1) % kSeriesColors.size()], 2, {}, Mark::disk, 2};
      if (!has_panels) s.end = labels[band];
      if (planes.size() > 1) s.end += fmt::format("{}azimuth {:g}°", has_panels ? "" : ", ", planes[plane]);
      for (size_t i = 0; i < r.views.size(); ++i)
        if (r.views[i].azimuth_deg == planes[plane])
          s.points.push_back(with_error(r.views[i].zenith_deg, r.at(i, band).mean, r.at(i, band).standard_error));
      panel.series.push_back(std::move(s));
    }
  }
  return chart;
}

Chart brf_hemisphere_chart(const BrfMeasurement& r) {
  const size_t bands = r.bands.size();
  if (bands > kMostPanels) fail({}, "--plot draws at most {} maps, {} bands were given", kMostPanels, bands);
  const std::vector<std::string> labels = labels_of(r.bands);
  const auto zeniths = distinct(r.views, &ViewDirection::zenith_deg);
  const double ring = 1.0 / double(zeniths.size());
  Chart chart{2 * std::min<size_t>(bands, 3)};
  for (size_t band = 0; band < bands; ++band) {
    ColorScale scale;
    scale.axis.range = range_of(r, band);
    const std::string title =
        fmt::format("{} {} {}", r.quantity, r.bands[band].name.empty() ? "at" : "in band", labels[band]);
    const PolarMap map{chart.panels.emplace_back(disk_panel(340, title))};
    for (size_t i = 0; i < r.views.size(); ++i) {
      const auto& [zenith, azimuth] = r.views[i];
      const double half = std::numbers::pi / double(std::ranges::count(r.views, zenith, &ViewDirection::zenith_deg)),
                   middle = azimuth * std::numbers::pi / 180, radius = zenith / 90;
      map.add_patch({std::max(0., radius - ring / 2), radius + ring / 2}, {middle - half, middle + half},
                    scale.color(r.at(i, band).mean));
    }
    map.add_circles();
    if (r.sun_zenith_deg)
      map.add_mark({-*r.sun_zenith_deg / 90, 0}, Mark::star, band == 0 ? "direction of the sun" : "");
    chart.panels.push_back(scale.panel(380));
  }
  return chart;
}

}  // namespace frond
