#include "report/structure_chart.h"

#include <fmt/format.h>

#include <numbers>

namespace frond {
namespace {

using Direction = StructureMeasurement::Direction;

/// Returns the label of an azimuth, or of the mean over all.
std::string label_of_azimuth(double azimuth) {
  return std::isnan(azimuth) ? "mean over azimuths" : fmt::format("azimuth {:g}°", azimuth);
}

}  // namespace

Chart structure_chart(const StructureMeasurement& m) {
  constexpr double kPanelWidth = 560, kPanelHeight = 420, kTick = 15;
  const Axis zenith{"zenith angle (degrees)", {0, 90}, false, kTick};
  Panel gaps{kPanelWidth, kPanelHeight, "Gap fraction", zenith, {"share of the rays", {0, 1}}};
  Range largest{0, 1};
  for (const Direction& d : m.directions) largest.include(d.clumping.mean);
  Panel indices{kPanelWidth,
                kPanelHeight,
                "Leaf projection, clumping and sunlit leaf area",
                zenith,
                {"", {0, 1.08 * largest.high}}};
  std::vector<double> azimuths;
  for (const Direction& d : m.directions)
    if (azimuths.empty() || !(d.azimuth_deg == azimuths.back() || std::isnan(d.azimuth_deg)))
      azimuths.push_back(d.azimuth_deg);
  for (size_t i = 0; i < azimuths.size(); ++i) {
    const std::string label = label_of_azimuth(azimuths[i]);
    const char* color = kSeriesColors[(i + 1) % kSeriesColors.size()];
    Series gap{label, color, 2, Dash::solid, Mark::disk}, random = line("", "#808080", 1, Dash::dashed);
    Series projection{"", color, 2, Dash::dashed, Mark::ring}, clumping{"", color, 2, Dash::solid, Mark::disk},
        sunlit{"", color, 2, Dash::dotted, Mark::open_square};
    if (i == 0) {
      random.label = "leaves at random, exp(−G LAI / cos θ)";
      projection.end = "G", clumping.end = "clumping", sunlit.end = "sunlit";
    }
    for (const Direction& d : m.directions) {
      if (!(d.azimuth_deg == azimuths[i] || std::isnan(azimuths[i]))) continue;
      const double cosine = std::cos(d.zenith_deg * std::numbers::pi / 180);
      const auto point = [&d](const MeanError& v) { return with_error(d.zenith_deg, v.mean, v.standard_error); };
      gap.points.push_back(point(d.gap));
      random.points.push_back({d.zenith_deg, std::exp(-d.projection.mean * m.leaf_area_index.mean / cosine)});
      projection.points.push_back(point(d.projection));
      clumping.points.push_back(point(d.clumping));
      sunlit.points.push_back(point(d.sunlit));
    }
    for (Series* one : {&random, &gap}) gaps.series.push_back(std::move(*one));
    for (Series* one : {&projection, &clumping, &sunlit}) indices.series.push_back(std::move(*one));
  }
  return {2, {std::move(gaps), std::move(indices)}};
}

}  // namespace frond
