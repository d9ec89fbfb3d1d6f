#include <fmt/format.h>

#include "report/chart.h"

namespace frond {
namespace {

constexpr double kCharacter = 7.8, kLegendLine = 20, kSample = 34;  // upper bound of a character's width in DejaVu Sans
constexpr double kLeader = 26;  // from a panel to the labels at the ends of its curves
constexpr double kFar = 50;     // coordinates are clipped at this multiple of the panel's size
constexpr const char *kStart = " text-anchor='start'", *kEnd = " text-anchor='end'", *kLarge = " font-size='15'",
                     *kSmall = " font-size='11'",
                     *kHalo = " font-size='11' stroke='#fff' stroke-width='3' paint-order='stroke'";
constexpr std::array kDashes{"none", "7,4", "2,3", "7,3,2,3"};
// Paths of the marks at radius 1.
constexpr const char *kDisk = "M-1 0a1 1 0 1 0 2 0a1 1 0 1 0-2 0z", *kSquare = "M-.9-.9H.9V.9H-.9z",
                     *kUp = "M-1.2.8L0-1.3 1.2.8z", *kDiamond = "M0-1.3L1.3 0 0 1.3-1.3 0z",
                     *kDown = "M-1.2-.8L0 1.3 1.2-.8z", *kPentagon = "M0-1.2L1.14-.37.7.97-.7.97-1.14-.37z",
                     *kCross = "M-1-1L1 1M-1 1L1-1", *kStar = "M-1 0H1M-.5-.87L.5.87M-.5.87L.5-.87",
                     *kBar = "M0-1.8V1.8";
constexpr std::array kMarkPaths{kDisk, kSquare, kUp, kDiamond, kDown, kPentagon, kDisk, kSquare, kCross, kStar, kBar};

/// Returns a decimal number for common magnitudes, otherwise a power of ten, as in 2×10⁻⁷.
std::string tick_text(double value) {
  constexpr std::array kDigits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  const double size = std::abs(value);
  if (size < 1e-300 || (size > 0.99e-4 && size < 0.99e6)) return fmt::format("{:.6g}", value + 0.0);  // no -0
  const int exponent = int(std::floor(std::log10(size * 1.000001)));
  const std::string factor = fmt::format("{:.3g}×", value / std::pow(10, exponent));
  std::string text = factor == "1×" ? "10" : factor + "10";
  for (const char c : fmt::format("{}", exponent)) text += c == '-' ? "⁻" : kDigits[size_t(c - '0')];
  return text;
}

/// Returns the smallest step of 1, 2 or 5 times a power of ten that is at least `least`.
double even_step(double least) {
  const double power = std::pow(10, std::floor(std::log10(least))), factor = least / power * 0.999999;
  return power * (factor <= 1 ? 1 : factor <= 2 ? 2 : factor <= 5 ? 5 : 10);
}

std::vector<Tick> log_ticks(const Range& r, double most) {
  const double decades = std::log10(r.high / r.low), every = std::ceil(decades / most);
  std::vector<Tick> ticks;
  for (double k = std::floor(std::log10(r.low)); k <= std::log10(r.high) + 1e-6; k += every)
    for (const double factor : {1., 2., 5.})
      if (const double v = factor * std::pow(10, k); factor == 1 || 3 * decades <= most)
        if (v >= r.low * 0.999999 && v <= r.high * 1.000001) ticks.push_back({v, tick_text(v)});
  return ticks;
}

/// Width of small text, relative to other text.
constexpr double kSmallWidth = 0.88;

/// Upper bound of a text's width in pixels.
double width_of(std::string_view text) {
  return kCharacter * double(std::ranges::count_if(text, [](char c) { return (c & 0xc0) != 0x80; }));
}

/// Returns an SVG text element. The text is escaped, and truncated if it is wider than `room`.
std::string text_at(double x, double y, std::string_view text, std::string_view more = "", double room = 1e6) {
  std::string xml;
  for (const char c : text) {
    if ((c & 0xc0) != 0x80 && (room -= kCharacter) < 0) break;
    xml += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c >= 0 && c < ' ' ? ' ' : c);
  }
  if (xml.empty()) return xml;
  return fmt::format("<text x='{:.2f}' y='{:.2f}'{}>{}{}</text>\n", x, y, more, xml, room < 0 ? "…" : "");
}

/// Returns the first line and the second, if there is one.
std::vector<std::string> lines_of(const std::string& text) {
  const size_t end = text.find('\n');
  if (end == std::string::npos) return {text};
  return {text.substr(0, end), text.substr(end + 1)};
}

std::string upward_text(double x, double y, std::string_view text) {
  return text_at(0, 0, text, fmt::format(" transform='translate({:.2f} {:.2f}) rotate(-90)'", x, y));
}

std::string stroke(std::string_view d, std::string_view color, double width, Dash dash = Dash::solid) {
  if (d.empty() || width == 0) return "";
  return fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='{}' stroke-dasharray='{}'/>\n", d, color,
                     width, kDashes[size_t(dash)]);
}

std::string mark_at(double x, double y, const Series& s) {
  if (s.mark == Mark::none) return "";
  const double width = s.mark < Mark::ring ? 0 : std::max(1.5, s.width) / s.mark_size;
  const std::string fill = s.mark == Mark::ring || s.mark == Mark::open_square ? "#fff" : s.color,
                    position = fmt::format("translate({:.2f} {:.2f}) scale({})", x, y, s.mark_size);
  return fmt::format("<path transform='{}' d='{}' fill='{}' stroke='{}' stroke-width='{:.3f}'/>\n", position,
                     kMarkPaths[size_t(s.mark)], fill, s.color, width);
}

/// Returns the axis with a range: its own, or the range of the points.
Axis with_range(Axis axis, const std::vector<Series>& series, double ChartPoint::*coordinate) {
  Range& r = axis.range;
  if (r.is_empty())
    for (const Series& s : series)
      for (const ChartPoint& p : s.points)
        if (!axis.is_logarithmic || p.*coordinate > 0) r.include(p.*coordinate);
  if (r.is_empty()) r = {1, 1};
  if (r.low == r.high) r = {r.low - std::abs(r.low) / 2, r.low == 0 ? 1 : r.low + std::abs(r.low)};
  return axis;
}

/// Draws one panel at a position of the chart.
class PanelDrawing {
 public:
  PanelDrawing(const Panel& panel, double left, double top, size_t id)
      : p_(panel),
        left_(left + (panel.is_map ? 8 : 78)),
        right_(left + panel.width - std::max(20.0, end_label_width(panel))),
        top_(top + (panel.title.empty() ? 12 : 32)),
        bottom_(top + panel.height - (panel.is_map ? 8 : 46)),
        x_(with_range(panel.x, panel.series, &ChartPoint::x)),
        y_(with_range(panel.y, panel.series, &ChartPoint::y)),
        id_(id) {}

  std::string svg() const {
    std::string out = text_at((left_ + right_) / 2, top_ - 10, p_.title, "", p_.width) + (p_.is_map ? "" : axes());
    out += fmt::format("<clipPath id='p{0}'><path d='{1}'/></clipPath>\n<g clip-path='url(#p{0})'>\n", id_, frame());
    for (const Series& s : p_.series) out += s.is_filled ? area(s) : curve(s);
    out += "</g>\n";
    for (const Series& s : p_.series) {
      for (const ChartPoint& p : s.points)
        if (is_inside(x_.position(p.x)) && is_inside(y_.position(p.y))) out += mark_at(x_at(p.x), y_at(p.y), s);
      if (!s.text.empty() && !s.points.empty())
        out += text_at(x_at(s.points[0].x), y_at(s.points[0].y) + 4, s.text, kHalo);
    }
    return out + end_labels();
  }

 private:
  static bool is_inside(double position) { return position >= -1e-6 && position <= 1 + 1e-6; }
  double x_at(double v) const { return std::lerp(left_, right_, std::clamp(x_.position(v), -kFar, kFar)); }
  double y_at(double v) const { return std::lerp(bottom_, top_, std::clamp(y_.position(v), -kFar, kFar)); }
  std::string frame() const {
    return fmt::format("M{:.2f},{:.2f}H{:.2f}V{:.2f}H{:.2f}Z", left_, top_, right_, bottom_, left_);
  }

  /// Returns a path through the points with a finite position.
  std::string path_of(const Series& s) const {
    std::string path;
    bool goes_on = false;
    for (const ChartPoint& p : s.points) {
      const bool has_place = std::isfinite(x_.position(p.x)) && std::isfinite(y_.position(p.y));
      if (has_place) path += fmt::format("{}{:.2f},{:.2f}", goes_on ? 'L' : 'M', x_at(p.x), y_at(p.y));
      goes_on = has_place;
    }
    return path;
  }
  std::string area(const Series& s) const {
    return fmt::format("<path d='{}' fill='{}' shape-rendering='crispEdges'/>\n", path_of(s), s.color);
  }
  std::string curve(const Series& s) const {
    std::string bars;
    // An error bar may extend to values <= 0, which a logarithmic axis cannot show.
    const auto end = [&](double v) { return y_at(y_.is_logarithmic ? std::max(v, y_.range.low / 10) : v); };
    for (const ChartPoint& p : s.points)
      if (p.bar.low < p.bar.high && std::isfinite(x_.position(p.x)))
        bars += fmt::format("M{:.2f},{:.2f}V{:.2f}", x_at(p.x), end(p.bar.low), end(p.bar.high));
    return stroke(s.width > 0 ? path_of(s) : "", s.color, s.width, s.dash) + stroke(bars, s.color, 1.2);
  }

  /// Returns the width that the labels at the ends of curves need.
  static double end_label_width(const Panel& panel) {
    constexpr double kMost = 0.45;  // of the panel
    double room = 0;
    for (const Series& s : panel.series) {
      const auto lines = lines_of(s.end);
      for (size_t i = 0; i < lines.size(); ++i)
        room = std::max(room, kLeader + (i == 0 ? 1.05 : kSmallWidth) * width_of(lines[i]) + 8);
    }
    return std::min(room, kMost * panel.width);
  }
  /// Returns the labels at the ends of curves, in the order of these ends and moved apart where they would overlap,
  /// each with a thin line to its curve.
  std::string end_labels() const {
    struct Label {
      const Series* series;
      double x, y, middle, height;  ///< x, y: end of the curve
    };
    std::vector<Label> labels;
    for (const Series& s : p_.series) {
      const auto last = std::find_if(s.points.rbegin(), s.points.rend(), [this](const ChartPoint& p) {
        return std::isfinite(x_.position(p.x)) && std::isfinite(y_.position(p.y));
      });
      if (s.end.empty() || last == s.points.rend()) continue;
      const double x = std::clamp(x_at(last->x), left_, right_), y = std::clamp(y_at(last->y), top_, bottom_);
      labels.push_back({&s, x, y, y, lines_of(s.end).size() > 1 ? 31.0 : 17.0});
    }
    std::ranges::stable_sort(labels, {}, &Label::y);
    for (size_t i = 1; i < labels.size(); ++i)
      labels[i].middle =
          std::max(labels[i].middle, labels[i - 1].middle + (labels[i - 1].height + labels[i].height) / 2);
    double low = bottom_ + 8;  // lower end of the room that is left
    for (auto label = labels.rbegin(); label != labels.rend(); ++label) {
      label->middle = std::min(label->middle, low - label->height / 2);
      low = label->middle - label->height / 2;
    }
    std::string out;
    for (const Label& l : labels) {
      const auto lines = lines_of(l.series->end);
      const double x = right_ + kLeader, y = l.middle + (lines.size() > 1 ? -2 : 5),
                   room = end_label_width(p_) - kLeader;
      out += stroke(fmt::format("M{:.2f},{:.2f}L{:.2f},{:.2f}", l.x + 6, l.y, x - 5, l.middle), l.series->color, 0.6);
      out += text_at(x, y, lines[0], fmt::format("{} fill='{}'", kStart, l.series->color), room);
      if (lines.size() > 1)
        out += text_at(x, y + 14, lines[1], std::string(kStart) + kSmall + " fill='#555'", room / kSmallWidth);
    }
    return out;
  }

  std::string axes() const {
    const double x = (left_ + right_) / 2, y = (top_ + bottom_) / 2;
    std::string grid, texts = text_at(x, bottom_ + 37, x_.label) + upward_text(left_ - 62, y, y_.label);
    for (const Tick& t : ticks_of(x_, (right_ - left_) / 70)) {
      grid += fmt::format("M{:.2f},{:.2f}V{:.2f}", x_at(t.value), top_, bottom_);
      texts += text_at(x_at(t.value), bottom_ + 17, t.text);
    }
    for (const Tick& t : ticks_of(y_, (bottom_ - top_) / 42)) {
      grid += fmt::format("M{:.2f},{:.2f}H{:.2f}", left_, y_at(t.value), right_);
      texts += text_at(left_ - 6, y_at(t.value) + 5, t.text, kEnd);
    }
    return stroke(grid, "#dcdcdc", 0.7) + stroke(frame(), "#000000", 1) + texts;
  }

  const Panel& p_;
  double left_, right_, top_, bottom_;
  Axis x_, y_;
  size_t id_;
};

/// Draws the legend column by column, starting at `y`, which is set to its lower end.
std::string legend(const Chart& chart, double width, double& y) {
  std::vector<Series> entries;
  double column = 0;
  for (const Panel& p : chart.panels)
    for (const Series& s : p.series)
      if (!s.label.empty()) entries.push_back(s), column = std::max(column, width_of(s.label));
  if (entries.empty()) return "";
  column = std::min(column + kSample + 36, width - 20);
  const auto most = std::max<size_t>(1, size_t((width - 20) / column)), rows = (entries.size() + most - 1) / most;
  const double left = (width - column * double((entries.size() + rows - 1) / rows)) / 2 + 10;
  std::string out;
  for (size_t i = 0; i < entries.size(); ++i) {
    const Series& s = entries[i];
    const double x = left + column * double(i / rows), middle = y + 6 + kLegendLine * (double(i % rows) + 0.5);
    if (s.mark != Mark::bar)
      out += stroke(fmt::format("M{:.2f},{:.2f}h{}", x, middle, kSample), s.color, s.width, s.dash);
    out += mark_at(x + kSample / 2, middle, s) +
           text_at(x + kSample + 8, middle + 5, s.label, kStart, column - kSample - 20);
  }
  y += kLegendLine * double(rows) + 16;
  return out;
}

}  // namespace

Range Range::widened() const {
  constexpr double kSteps = 6;
  return {std::pow(10, std::floor(std::log10(low) * kSteps - 0.5) / kSteps),
          std::pow(10, std::ceil(std::log10(high) * kSteps + 0.5) / kSteps)};
}

double Axis::position(double value) const {
  if (is_logarithmic) return std::log(value / range.low) / std::log(range.high / range.low);
  return (value - range.low) / (range.high - range.low);
}

std::vector<Tick> ticks_of(const Axis& axis, double most) {
  const auto& [low, high] = axis.range;
  if (!axis.ticks.empty()) return axis.ticks;
  if (axis.is_logarithmic)
    if (auto ticks = log_ticks(axis.range, most); ticks.size() > 1) return ticks;
  const double step = axis.step > 0 ? axis.step : even_step((high - low) / most), first = std::ceil(low / step - 1e-6);
  std::vector<Tick> ticks;
  for (int i = 0; i < 1000 && (first + i) * step <= high + 1e-6 * step; ++i)
    ticks.push_back({(first + i) * step, tick_text((first + i) * step)});
  return ticks;
}

std::string chart_svg(const Chart& c) {
  double width = 0, y = c.title.empty() ? 0 : 26, left = 0;
  for (size_t i = 0; i < std::min(c.columns, c.panels.size()); ++i) width += c.panels[i].width;
  std::string body = text_at(width / 2, y, c.title, kLarge, width - 20);
  for (const std::string& caption : c.captions) body += text_at(width / 2, y += 18, caption, kSmall, width);
  for (size_t i = 0; i < c.panels.size(); ++i) {
    body += PanelDrawing(c.panels[i], left, y, i).svg();
    left += c.panels[i].width;
    if ((i + 1) % c.columns == 0 || i + 1 == c.panels.size()) y += c.panels[i].height, left = 0;
  }
  body += legend(c, width, y);
  return fmt::format("<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' viewBox='0 0 {0} {1}' ", width,
                     y) +
         "font-family='DejaVu Sans, sans-serif' font-size='13' text-anchor='middle'>\n" +
         fmt::format("<path d='M0,0H{}V{}H0Z' fill='#fff'/>\n", width, y) + body + "</svg>\n";
}

}  // namespace frond
