#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace frond {

/// Eight colours that people of any colour vision tell apart (Okabe and Ito 2008), darkest first; their yellow, too
/// faint on paper, gives way to a grey.
inline constexpr std::array<const char*, 8> kSeriesColors{"#000000", "#0072b2", "#d55e00", "#009e73",
                                                          "#cc79a7", "#e69f00", "#56b4e9", "#999999"};

/// An interval; empty where `low` is above `high`.
struct Range {
  double low = HUGE_VAL, high = -HUGE_VAL;

  bool is_empty() const { return !(low <= high); }
  /// What is not finite is left out.
  void include(double v) {
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  }
  /// For a logarithmic axis: with room of up to a third of a decade around the values.
  Range widened() const;
};

struct Tick {
  double value;
  std::string text;
};

struct Axis {
  std::string label;  ///< with the unit
  Range range = {};   ///< empty: that of the points; {low, -HUGE_VAL}: from `low` on
  bool is_logarithmic = false;
  double step = 0;               ///< between ticks of a linear axis; 0: chosen
  std::vector<Tick> ticks = {};  ///< empty: chosen

  /// 0 at the low end of the range, 1 at the high end. Not finite for 0 and less on a logarithmic axis.
  double position(double value) const;
};

/// Ticks within the range, `most` or a few more: multiples of 1, 2 or 5 times a power of ten; on logarithmic axes of
/// many decades powers of ten.
std::vector<Tick> ticks_of(const Axis& axis, double most);

enum class Dash { solid, dashed, dotted, dash_dotted };
enum class Mark { disk, square, up, diamond, down, pentagon, ring, open_square, cross, star, bar, none };
/// The order in which charts take marks, by their number.
inline constexpr Mark series_mark(size_t i) { return Mark(i % size_t(Mark::cross)); }

struct ChartPoint {
  double x, y;
  Range bar = {};  ///< of errors of y; empty: none
};
/// With a bar of `error` each way.
inline ChartPoint with_error(double x, double y, double error) { return {x, y, {y - error, y + error}}; }

/// A curve, interrupted where a point has no position, or an area. Without points: an entry of the legend.
struct Series {
  std::string label, color;  ///< label: in the legend; empty: none
  double width = 1.5;        ///< of lines, pixels; 0: no line
  Dash dash = Dash::solid;
  Mark mark = Mark::none;
  double mark_size = 3.5;  ///< radius, pixels
  std::vector<ChartPoint> points = {};
  std::string text = {};  ///< on the first point
  bool is_filled = false;
};
inline Series line(std::string label, std::string color, double width = 1.5, Dash dash = Dash::solid,
                   std::vector<ChartPoint> points = {}) {
  return {std::move(label), std::move(color), width, dash, Mark::none, 0, std::move(points)};
}
inline Series marks(std::string label, std::string color, Mark mark, double size, std::vector<ChartPoint> points = {}) {
  return {std::move(label), std::move(color), 0, Dash::solid, mark, size, std::move(points)};
}

struct Panel {
  double width, height;  ///< pixels, with its texts
  std::string title;
  Axis x, y;
  std::string mirrored = {};  ///< label of an axis on the right that counts 1 - y; empty: none
  bool is_map = false;        ///< x and y have one scale and no axes
  std::vector<Series> series = {};
};

/// Panels row by row; a legend of all their series is added below.
struct Chart {
  size_t columns = 1;
  std::vector<Panel> panels = {};
  std::string title = {};
  std::vector<std::string> captions = {};  ///< smaller, below the title
};

/// SVG that refers to nothing outside. The same chart gives the same text.
std::string chart_svg(const Chart& chart);
/// Why no PNG can be made; empty: it can, by librsvg.
std::string png_refusal();

/// Refuses, by InputError, a chart that cannot be made: a name that does not end in .svg or .png, a folder that does
/// not take it, PNG without librsvg.
void check_chart(const std::string& path);
/// Writes SVG or PNG, by the path's ending, whole or not at all.
void write_chart(const std::string& path, const Chart& chart);

/// The values that occur, each once, in their first order.
template <class Items, class Get>
auto distinct(const Items& items, const Get& get) {
  std::vector<std::decay_t<decltype(std::invoke(get, items[0]))>> values;
  for (const auto& item : items)
    if (std::ranges::find(values, std::invoke(get, item)) == values.end()) values.push_back(std::invoke(get, item));
  return values;
}

template <class T>
size_t place_in(const std::vector<T>& values, const T& value) {
  return size_t(std::ranges::find(values, value) - values.begin());
}

}  // namespace frond
