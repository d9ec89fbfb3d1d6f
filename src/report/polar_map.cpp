#include "report/polar_map.h"

#include <fmt/format.h>

#include <numbers>

namespace frond {

std::string ColorScale::color(double value) const {
  const double position = axis.position(value), at = std::clamp(position, 0., 1.) * double(palette.size() - 1);
  if (std::isnan(position)) return "#c0c0c0";
  const size_t i = std::min(size_t(at), palette.size() - 2);
  std::string text = "#";
  for (const int shift : {16, 8, 0}) {
    const double from = palette[i] >> shift & 255, to = palette[i + 1] >> shift & 255;
    text += fmt::format("{:02x}", std::lround(std::lerp(from, to, at - double(i))));
  }
  return text;
}

Panel ColorScale::panel(double height) const {
  constexpr int kShades = 128;
  Axis y{axis.label, {0, 1}, false, 0, ticks_of(axis, height / 60)};
  for (Tick& t : y.ticks) t.value = axis.position(t.value);
  Panel panel{116, height, " ", {"", {0.1, 0.9}, false, 1}, y};
  for (double i = 0; i < kShades; ++i) {
    const double low = i / kShades, high = (i + 1) / kShades;
    const std::string shade = ColorScale{{"", {0, kShades - 1}}, palette}.color(i);
    panel.series.push_back({"", shade, 0, {}, Mark::none, 0, {{0, low}, {1, low}, {1, high}, {0, high}}, "", true});
  }
  return panel;
}

void PolarMap::add_patch(const Range& radius, const Range& phi, std::string color) const {
  const int steps = std::max(1, int((phi.high - phi.low) * 60 / std::numbers::pi));
  Series& area = panel.series.emplace_back(line("", std::move(color), 0));
  area.is_filled = true;
  for (int i = 0; i <= 2 * steps + 1; ++i)
    area.points.push_back(at(i <= steps ? radius.low : radius.high,
                             std::lerp(phi.low, phi.high, double(i <= steps ? i : 2 * steps + 1 - i) / steps)));
}

void PolarMap::add_mark(const ChartPoint& point, Mark mark, std::string label) const {
  panel.series.push_back({"", "#ffffff", 4, Dash::solid, mark, 7.5, {point}});
  panel.series.push_back(marks(std::move(label), "#000000", mark, 6, {point}));
}

void PolarMap::add_circles(const std::array<double, 3>& radii) const {
  for (const size_t i : {0, 1, 2}) {
    Series& circle = panel.series.emplace_back(line("", i == 2 ? "#000000" : "#808080", 1));
    circle.text = std::array{"30°", "60°", "90°"}[i];
    for (int k = 0; k <= 120; ++k) circle.points.push_back(at(radii[i], (k + 15) * std::numbers::pi / 60));
  }
}

Panel disk_panel(double size, std::string title) {
  return {size + 28, size + 40, std::move(title), {"", {-1.05, 1.05}}, {"", {-1.05, 1.05}}, true};
}

}  // namespace frond
