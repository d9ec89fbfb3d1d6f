#include "study/compare/curve_style.h"

#include <fmt/format.h>

#include <cmath>

#include "report/gnuplot.h"

namespace frond::compare {
namespace {

/// 1, 2, 5 where there are few decades.
std::string ticks(char axis, const AxisRange& r) {
  if (r.high / r.low > 3000) return "";
  std::string list;
  for (double decade = std::pow(10, std::floor(std::log10(r.low))); decade <= r.high; decade *= 10)
    for (const double k : {1.0, 2.0, 5.0})
      if (const double v = decade * k; v >= r.low && v <= r.high)
        list += fmt::format("{}'{:g}' {:g}", list.empty() ? "" : ", ", v, v);
  return fmt::format("set {}tics ({})\n", axis, list);
}

}  // namespace

std::string line_style(size_t candidate) {
  constexpr size_t kSolid = 4;
  return fmt::format("lc rgb '{}' dt {}", kSeriesColors[candidate], candidate < kSolid ? 1 : 2);
}

AxisRange AxisRange::widened() const {
  constexpr double kSteps = 6;
  return {std::pow(10, std::floor(std::log10(low) * kSteps - 0.5) / kSteps),
          std::pow(10, std::ceil(std::log10(high) * kSteps + 0.5) / kSteps)};
}

std::string chart_frame() {
  return "set grid xtics ytics lt 1 lc rgb '#dcdcdc' lw 0.6\nset border 3\nset tics nomirror\nset rmargin 3\n"
         "set tmargin 1.5\n";
}

std::string log_axis(char axis, const AxisRange& r, const std::string& label) {
  return fmt::format("set logscale {0}\nset {0}range [{1}:{2}]\nset {0}label {3}\nset format {0} '%g'\n", axis, r.low,
                     r.high, gnuplot_text(label)) +
         ticks(axis, r);
}

std::string key_below(size_t lines) {
  return fmt::format("set bmargin {}\nset key at screen 0.5,0.01 center bottom vertical Left reverse maxrows {}\n",
                     lines + 4, lines);
}

}  // namespace frond::compare
