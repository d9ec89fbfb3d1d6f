#include "cli/compare/curves_chart.h"

#include <algorithm>
#include <cmath>

#include "cli/gnuplot.h"

namespace frond::compare {
namespace {

struct Point {
  double seconds, value, low, high;
};

Point point_of(const Rung& rung, Measure measure) {
  const double t = rung.cost.cpu_seconds;
  if (measure == Measure::flip) return {t, rung.flip, rung.flip, rung.flip};
  const MeanSquare& e = rung.errors[measure == Measure::rms_leaf ? kLeaf : kAll][kRgb].total;
  return {t, e.root(), e.root_at(-kZ95), e.root_at(kZ95)};
}

/// Those that a logarithmic axis can show.
std::vector<Point> points_of(const Subject& subject, Measure measure) {
  std::vector<Point> points;
  for (const Rung& rung : subject.rungs)
    if (const Point p = point_of(rung, measure); p.seconds > 0 && p.value > 0) points.push_back(p);
  return points;
}

/// A bar that reaches down to nothing ends at the axis.
std::string data_block(size_t i, const std::vector<Point>& points) {
  std::string text = fmt::format("$c{} << EOD\n", i);
  for (const Point& p : points)
    text += fmt::format("{} {} {} {}\n", p.seconds, p.value, std::max(p.low, p.value / 100), p.high);
  return text + "EOD\n";
}

std::string frontier_block(const std::vector<std::vector<Point>>& curves) {
  std::vector<CostAndError> all;
  for (const auto& curve : curves)
    for (const Point& p : curve) all.push_back({p.seconds, p.value});
  std::string text = "$frontier << EOD\n";
  for (const size_t i : pareto_frontier(all)) text += fmt::format("{} {}\n", all[i].cost, all[i].error);
  return text + "EOD\n";
}

struct Range {
  double low, high;
};

/// Whole thirds of a decade around the values, so that no curve touches the frame.
Range widened(Range r) {
  constexpr double kSteps = 6;
  return {std::pow(10, std::floor(std::log10(r.low) * kSteps - 0.5) / kSteps),
          std::pow(10, std::ceil(std::log10(r.high) * kSteps + 0.5) / kSteps)};
}

void include(Range& r, double v) { r = {std::min(r.low, v), std::max(r.high, v)}; }

std::string axes(const Range& x, const Range& y, Measure measure, const Comparison& c) {
  const char* error = measure == Measure::flip       ? "mean FLIP"
                      : measure == Measure::rms_leaf ? "RMS error, leaf pixels"
                                                     : "RMS error, all pixels";
  return fmt::format(
      "set logscale xy\nset xrange [{}:{}]\nset yrange [{}:{}]\n"
      "set xlabel {}\nset ylabel {}\n"
      "set grid xtics ytics lt 1 lc rgb '#dcdcdc' lw 0.6\n"
      "set format x '%g'\nset format y '%g'\nset border 3\nset tics nomirror\nset rmargin 3\nset tmargin 1.5\n",
      x.low, x.high, y.low, y.high, gnuplot_text(fmt::format("CPU time of one {} × {} render (s)", c.width, c.height)),
      gnuplot_text(measure == Measure::flip ? error : std::string(error) + " (linear SMPTE-C)"));
}

/// Ticks 1, 2, 5 where there are few decades.
std::string ticks(char axis, const Range& r) {
  if (r.high / r.low > 3000) return "";
  std::string list;
  for (double decade = std::pow(10, std::floor(std::log10(r.low))); decade <= r.high; decade *= 10)
    for (const double k : {1.0, 2.0, 5.0})
      if (const double v = decade * k; v >= r.low && v <= r.high)
        list += fmt::format("{}'{:g}' {:g}", list.empty() ? "" : ", ", v, v);
  return fmt::format("set {}tics ({})\n", axis, list);
}

constexpr std::array<int, kMostCurves> kPoints{7, 5, 9, 13, 11, 6, 4, 8};
constexpr std::array<int, kMostCurves> kDashes{1, 1, 1, 1, 2, 2, 2, 2};

std::string style(size_t i) { return fmt::format("lc rgb '{}' dt {}", kSeriesColors[i], kDashes[i]); }

std::string curve(size_t i, const std::string& label) {
  return fmt::format(
      ", $c{0} using 1:2 with lines {1} lw 2 notitle, $c{0} using 1:3:(0):($4-$3) with vectors nohead lc rgb '{2}' lw "
      "1.2 "
      "notitle, $c{0} using 1:2 with points lc rgb '{2}' pt {3} ps 0.8 notitle, "
      "NaN with linespoints {1} lw 2 pt {3} ps 0.8 title {4}",
      i, style(i), kSeriesColors[i], kPoints[i], gnuplot_text(label));
}

/// The level of the bias, from where noise has fallen to it.
struct Plateau {
  double bias, seconds;
};

std::optional<Plateau> plateau_of(const Subject& subject, Measure measure) {
  if (measure == Measure::flip) return {};
  const Convergence c = subject.convergence(measure == Measure::rms_leaf ? kLeaf : kAll, kRgb);
  const auto effort = c.until_plateau();
  if (!effort) return {};
  return Plateau{c.bias().root(), effort->seconds};
}

std::string title(const Subject& subject, const std::optional<Plateau>& plateau) {
  if (!plateau) return subject.candidate.label;
  return fmt::format("{}: bias {:.2g}, noise below it from {:.2g} s", subject.candidate.label, plateau->bias,
                     plateau->seconds);
}

}  // namespace

bool has_curves(const Comparison& c, Measure measure) {
  return std::ranges::any_of(c.subjects, [measure](const Subject& s) { return !points_of(s, measure).empty(); });
}

std::string curves_chart(const Comparison& c, Measure measure) {
  std::vector<std::vector<Point>> curves;
  std::vector<std::optional<Plateau>> plateaus;
  Range x{1e300, 0}, y{1e300, 0};
  for (const Subject& s : c.subjects) {
    curves.push_back(points_of(s, measure));
    plateaus.push_back(plateau_of(s, measure));
    for (const Point& p : curves.back()) include(x, p.seconds), include(y, p.value);
    if (plateaus.back()) include(y, plateaus.back()->bias), include(x, plateaus.back()->seconds);
  }
  x = widened(x), y = widened(y);
  std::string script, marks, plot;
  for (size_t i = 0; i < curves.size(); ++i) script += data_block(i, curves[i]);
  script += frontier_block(curves) + axes(x, y, measure, c) + ticks('x', x) + ticks('y', y);
  script += fmt::format("set bmargin {}\nset key at screen 0.5,0.01 center bottom vertical Left reverse maxrows {}\n",
                        curves.size() + 5, curves.size() + 1);
  for (size_t i = 0; i < curves.size(); ++i) {
    const auto& p = plateaus[i];
    if (p) {
      const double from = std::clamp(p->seconds, x.low, x.high);
      script += fmt::format("$p{} << EOD\n{} {}\n{} {}\nEOD\n", i, from, p->bias, x.high, p->bias);
      marks += fmt::format(
          ", $p{0} using 1:2 with lines lc rgb '{1}' dt 3 lw 2 notitle, $p{0} using 1:2 every ::0::0 with points lc "
          "rgb "
          "'{1}' pt 2 ps 1.3 lw 2 notitle",
          i, kSeriesColors[i]);
    }
    plot += curve(i, title(c.subjects[i], p));
  }
  return script +
         "plot $frontier using 1:2 with lines lc rgb '#d9d9d9' lw 9 title 'Pareto frontier: nothing measured "
         "beats it in both'" +
         plot + marks + "\n";
}

}  // namespace frond::compare
