#pragma once

#include <span>

#include "report/chart.h"

namespace frond {

/// Blue to yellow by way of green, brighter all the way: readable without colour vision and in grey (viridis, by van
/// der Walt and Smith).
inline constexpr std::array<int, 9> kViridis{0x440154, 0x472c7a, 0x3b518b, 0x2c718e, 0x21908d,
                                             0x27ad81, 0x5cc863, 0xaadc32, 0xfde725};

/// From numbers to colours (0xrrggbb), evenly spaced along an axis. What is beyond its ends has their colours, what is
/// no number is grey.
struct ColorScale {
  Axis axis;
  std::span<const int> palette = kViridis;

  std::string color(double value) const;
  /// The scale itself, to stand beside maps.
  Panel panel(double height) const;
};

/// A disk on a panel: directions at their radius (1: the horizon) and azimuth (radians) about its middle.
struct PolarMap {
  Panel& panel;
  double center_x = 0;

  ChartPoint at(double radius, double phi) const { return {center_x + radius * std::cos(phi), radius * std::sin(phi)}; }
  /// What lies between two radii and two azimuths.
  void add_patch(const Range& radius, const Range& phi, std::string color) const;
  /// A direction, seen on any colour; `label`: in the legend.
  void add_mark(const ChartPoint& point, Mark mark, std::string label) const;
  /// For 30, 60 and 90 degrees from the middle.
  void add_circles(const std::array<double, 3>& radii = {1. / 3, 2. / 3, 1}) const;
};

/// A panel for one disk.
Panel disk_panel(double size, std::string title);

}  // namespace frond
