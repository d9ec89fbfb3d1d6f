#include "study/compare/curves_chart.h"

#include <algorithm>
#include <cmath>

#include "report/gnuplot.h"
#include "study/compare/curve_style.h"
#include "study/compare/figures.h"

namespace frond::compare {
namespace {

struct Point {
  double seconds, value, low, high;
};

/// Errors as the axis has them.
Point point_of(const Rung& rung, Measure measure, const ErrorUnit& unit) {
  const double t = rung.cost.cpu_seconds;
  if (measure == Measure::flip) return {t, rung.flip.value_or(0), rung.flip.value_or(0), rung.flip.value_or(0)};
  const MeanSquare& e = rung.errors[measure == Measure::rms_leaf ? kLeaf : kAll][kTogether].total;
  return {t, unit.on_axis(e.root()), unit.on_axis(e.root_at(-kZ95)), unit.on_axis(e.root_at(kZ95))};
}

/// Those that a logarithmic axis can show.
std::vector<Point> points_of(const Subject& subject, Measure measure, const ErrorUnit& unit) {
  std::vector<Point> points;
  for (const Rung& rung : subject.rungs)
    if (const Point p = point_of(rung, measure, unit); p.seconds > 0 && p.value > 0) points.push_back(p);
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

std::string axes(const AxisRange& x, const AxisRange& y, Measure measure, const Comparison& c) {
  const std::string error =
      measure == Measure::flip ? "mean FLIP"
                               : fmt::format("RMS error, {} pixels ({})", measure == Measure::rms_leaf ? "leaf" : "all",
                                             c.request.error_unit().of_axis(c.channels));
  return chart_frame() + log_axis('x', x, fmt::format("CPU time of one {} × {} render (s)", c.width, c.height)) +
         log_axis('y', y, error);
}

std::string curve(size_t i, const std::string& label) {
  return fmt::format(
      ", $c{0} using 1:2 with lines {1} lw 2 notitle, $c{0} using 1:3:(0):($4-$3) with vectors nohead lc rgb '{2}' lw "
      "1.2 notitle, $c{0} using 1:2 with points lc rgb '{2}' pt {3} ps 0.8 notitle, "
      "NaN with linespoints {1} lw 2 pt {3} ps 0.8 title {4}",
      i, line_style(i), kSeriesColors[i], kPoints[i], gnuplot_text(label));
}

/// The level of the bias, from where noise has fallen to it.
struct Plateau {
  double bias, seconds;
};

std::optional<Plateau> plateau_of(const Subject& subject, Measure measure) {
  if (measure == Measure::flip) return {};
  const Convergence c = subject.convergence(measure == Measure::rms_leaf ? kLeaf : kAll);
  const auto effort = c.until_plateau();
  if (!effort) return {};
  return Plateau{c.bias().root(), effort->seconds};
}

std::string title(const Subject& subject, const std::optional<Plateau>& plateau, const ErrorUnit& unit) {
  if (!plateau) return subject.candidate.label;
  return fmt::format("{}: bias {}, noise below it from {} s", subject.candidate.label, unit.rounded(plateau->bias),
                     figures(plateau->seconds, 2));
}

}  // namespace

bool has_curves(const Comparison& c, Measure measure) {
  const ErrorUnit unit = c.request.error_unit();
  return std::ranges::any_of(c.subjects, [&](const Subject& s) { return !points_of(s, measure, unit).empty(); });
}

std::string curves_chart(const Comparison& c, Measure measure) {
  const ErrorUnit unit = c.request.error_unit();
  std::vector<std::vector<Point>> curves;
  std::vector<std::optional<Plateau>> plateaus;
  AxisRange x, y;
  for (const Subject& s : c.subjects) {
    curves.push_back(points_of(s, measure, unit));
    plateaus.push_back(plateau_of(s, measure));
    for (const Point& p : curves.back()) x.include(p.seconds), y.include(p.value);
    if (plateaus.back()) y.include(unit.on_axis(plateaus.back()->bias)), x.include(plateaus.back()->seconds);
  }
  x = x.widened(), y = y.widened();
  std::string script, marks, plot;
  for (size_t i = 0; i < curves.size(); ++i) script += data_block(i, curves[i]);
  script += frontier_block(curves) + axes(x, y, measure, c) + key_below(curves.size() + 1);
  for (size_t i = 0; i < curves.size(); ++i) {
    const auto& p = plateaus[i];
    if (p) {
      const double from = std::clamp(p->seconds, x.low, x.high);
      const double level = unit.on_axis(p->bias);
      script += fmt::format("$p{} << EOD\n{} {}\n{} {}\nEOD\n", i, from, level, x.high, level);
      marks += fmt::format(
          ", $p{0} using 1:2 with lines lc rgb '{1}' dt 3 lw 2 notitle, $p{0} using 1:2 every ::0::0 with points lc "
          "rgb '{1}' pt 2 ps 1.3 lw 2 notitle",
          i, kSeriesColors[i]);
    }
    plot += curve(i, title(c.subjects[i], p, unit));
  }
  return script +
         "plot $frontier using 1:2 with lines lc rgb '#d9d9d9' lw 9 title 'Pareto frontier: nothing measured "
         "beats it in both'" +
         plot + marks + "\n";
}

}  // namespace frond::compare
