#pragma once

#include <span>

#include "report/chart.h"

namespace frond {

/// Colour map viridis (van der Walt and Smith), blue to yellow with rising brightness: readable without colour vision
/// and in greyscale. Values are 0xrrggbb.
inline constexpr std::array<int, 9> kViridis{0x440154, 0x472c7a, 0x3b518b, 0x2c718e, 0x21908d,
                                             0x27ad81, 0x5cc863, 0xaadc32, 0xfde725};

/// Maps numbers to colours (0xrrggbb) along an axis. Values beyond the ends have the end colours; NaN is grey.
struct ColorScale {
  Axis axis;
  std::span<const int> palette = kViridis;

  std::string color(double value) const;
  /// Returns a legend of the scale, to be placed beside maps.
  Panel panel(double height) const;
};

/// A polar map on a panel. Directions have a radius (1: the horizon) and an azimuth (radians) about the centre.
struct PolarMap {
  Panel& panel;
  double center_x = 0;

  ChartPoint at(double radius, double phi) const { return {center_x + radius * std::cos(phi), radius * std::sin(phi)}; }
  /// Fills the area between two radii and two azimuths.
  void add_patch(const Range& radius, const Range& phi, std::string color) const;
  /// Marks a direction, in black and white so that it is visible on any colour. `label`: in the legend.
  void add_mark(const ChartPoint& point, Mark mark, std::string label) const;
  /// Draws circles, by default at 30, 60 and 90 degrees from the centre.
  void add_circles(const std::array<double, 3>& radii = {1. / 3, 2. / 3, 1}) const;
};

/// Returns a panel for one polar map. `size` is in pixels.
Panel disk_panel(double size, std::string title);

}  // namespace frond
