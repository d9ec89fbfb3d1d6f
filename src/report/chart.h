#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace frond {

/// Eight colours that are distinguishable with any colour vision (Okabe and Ito 2008), darkest first. Their yellow is
/// replaced by a grey, because it is too faint on paper.
inline constexpr std::array<const char*, 8> kSeriesColors{"#000000", "#0072b2", "#d55e00", "#009e73",
                                                          "#cc79a7", "#e69f00", "#56b4e9", "#999999"};

/// An interval; empty if `low` is above `high`.
struct Range {
  double low = HUGE_VAL, high = -HUGE_VAL;

  bool is_empty() const { return !(low <= high); }
  /// Extends the interval to `v`. Values that are not finite are ignored.
  void include(double v) {
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  }
  /// Returns the interval widened by up to a third of a decade at each end, for a logarithmic axis.
  Range widened() const;
};

/// A labelled position on an axis.
struct Tick {
  double value;
  std::string text;
};

struct Axis {
  std::string label;  ///< with the unit
  Range range = {};   ///< empty: the range of the points; {low, -HUGE_VAL}: from `low` to the largest point
  bool is_logarithmic = false;
  double step = 0;               ///< between ticks of a linear axis; 0: automatic
  std::vector<Tick> ticks = {};  ///< empty: automatic

  /// Returns the position from 0 (low end) to 1 (high end); not finite for values <= 0 on a logarithmic axis.
  double position(double value) const;
};

/// Returns about `most` ticks within the range: multiples of 1, 2 or 5 times a power of ten; powers of ten on
/// logarithmic axes of many decades.
std::vector<Tick> ticks_of(const Axis& axis, double most);

enum class Dash { solid, dashed, dotted, dash_dotted };
enum class Mark { disk, square, up, diamond, down, pentagon, ring, open_square, cross, star, bar, none };
/// Returns the mark of series i.
inline constexpr Mark series_mark(size_t i) { return Mark(i % size_t(Mark::cross)); }

struct ChartPoint {
  double x, y;
  Range bar = {};  ///< error bar of y; empty: none
};
/// Returns a point with an error bar of y +- error.
inline ChartPoint with_error(double x, double y, double error) { return {x, y, {y - error, y + error}}; }

/// A curve, interrupted at points that are not finite, or a filled area. A series without points is an entry of the
/// legend. Few curves have labels at their ends, which are read without a legend.
struct Series {
  std::string label, color;  ///< label: in the legend; empty: not in the legend
  double width = 1.5;        ///< of lines, pixels; 0: no line
  Dash dash = Dash::solid;
  Mark mark = Mark::none;
  double mark_size = 3.5;  ///< radius, pixels
  std::vector<ChartPoint> points = {};
  std::string text = {};  ///< annotation of the first point
  bool is_filled = false;
  std::string end = {};  ///< label beside the last point, right of the panel; its second line is smaller
};
inline Series line(std::string label, std::string color, double width = 1.5, Dash dash = Dash::solid,
                   std::vector<ChartPoint> points = {}) {
  return {std::move(label), std::move(color), width, dash, Mark::none, 0, std::move(points)};
}
inline Series marks(std::string label, std::string color, Mark mark, double size, std::vector<ChartPoint> points = {}) {
  return {std::move(label), std::move(color), 0, Dash::solid, mark, size, std::move(points)};
}

struct Panel {
  double width, height;  ///< pixels, including titles and labels
  std::string title;
  Axis x, y;
  bool is_map = false;  ///< x and y have one scale; no axes are drawn
  std::vector<Series> series = {};
};

/// Panels in rows of `columns`, with a legend of all their series below.
struct Chart {
  size_t columns = 1;
  std::vector<Panel> panels = {};
  std::string title = {};
  std::vector<std::string> captions = {};  ///< smaller, below the title
};

/// Returns a self-contained SVG. Equal charts give equal text.
std::string chart_svg(const Chart& chart);
/// Returns the content of a PNG file. Throws InputError if PNG is not available.
std::string chart_png(const Chart& chart);
/// Returns the reason why PNG is not available (librsvg is missing); "" if it is available.
std::string png_refusal();

/// Throws InputError if the chart cannot be written: a name that does not end in .svg or .png, a folder that is not
/// writable, PNG without librsvg.
void check_chart(const std::string& path);
/// Writes SVG or PNG, selected by the extension. The file is replaced only when it is complete. Throws InputError.
void write_chart(const std::string& path, const Chart& chart);

/// Returns the distinct values of `get`, in the order of their first occurrence.
template <class Items, class Get>
auto distinct(const Items& items, const Get& get) {
  std::vector<std::decay_t<decltype(std::invoke(get, items[0]))>> values;
  for (const auto& item : items)
    if (std::ranges::find(values, std::invoke(get, item)) == values.end()) values.push_back(std::invoke(get, item));
  return values;
}

/// Returns the index of `value` in `values`; values.size() if absent.
template <class T>
size_t index_of(const std::vector<T>& values, const T& value) {
  return size_t(std::ranges::find(values, value) - values.begin());
}

}  // namespace frond
