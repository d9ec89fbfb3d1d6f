#pragma once

#include <algorithm>
#include <array>
#include <string>

namespace frond::compare {

/// The most candidates that one chart can tell apart.
inline constexpr size_t kMostCurves = 8;

/// Gnuplot's shapes of points: candidates differ by more than their colour.
inline constexpr std::array<int, kMostCurves> kPoints{7, 5, 9, 13, 11, 6, 4, 8};

/// Colour and dashes of one candidate's lines.
std::string line_style(size_t candidate);

/// What a logarithmic axis shows.
struct AxisRange {
  double low = 1e300, high = 0;

  void include(double v) { low = std::min(low, v), high = std::max(high, v); }
  /// With room of up to a third of a decade around the values, so that no curve touches the frame.
  AxisRange widened() const;
};

/// Frame and grid, as all charts have them.
std::string chart_frame();
/// Range, label and ticks of one logarithmic axis, 'x' or 'y'.
std::string log_axis(char axis, const AxisRange& range, const std::string& label);
/// Below the axes, with room for so many lines.
std::string key_below(size_t lines);

}  // namespace frond::compare
