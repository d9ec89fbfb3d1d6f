#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "report/bench_report.h"
#include "report/gnuplot.h"

namespace frond {
namespace {

constexpr std::array kMarks{7, 5, 9, 11, 13, 15};  // disk, square, triangles up and down, diamond, pentagon

struct Panel {
  const char* title;
  Worth SampleWorth::*worth;
};
constexpr std::array<Panel, 2> kPanels{
    {{"under an overcast sky", &SampleWorth::sky}, {"under the sun", &SampleWorth::sun}}};

/// Places in the lists of materials and angles.
struct Place {
  size_t material, angle;
};

template <class T>
size_t place_in(std::vector<T>& list, const T& value) {
  const auto it = std::ranges::find(list, value);
  if (it != list.end()) return static_cast<size_t>(it - list.begin());
  list.push_back(value);
  return list.size() - 1;
}

class Scatter {
 public:
  explicit Scatter(const std::vector<BenchReading>& readings) {
    const int lanes = std::ranges::max(readings, {}, &BenchReading::lanes).lanes;
    for (const BenchReading& r : readings) {
      if (r.lanes != lanes) continue;
      places_.push_back({place_in(materials_, r.material), place_in(angles_, r.theta_deg)});
      readings_.push_back(&r);
    }
    check_bench_chart(materials_.size(), angles_.size());
    xlabel_ = fmt::format("CPU time of a hit, {} wavelength{} (ns)", lanes, lanes == 1 ? "" : "s");
  }

  std::string script() const {
    std::string text = "set multiplot layout 1,2\nset logscale xy\nset format y '10^{%L}'\nset termoption enhanced\n";
    text += fmt::format("set xlabel {}\n", gnuplot_text(xlabel_));
    text += fmt::format("set bmargin {}\n", 6 + (materials_.size() + angles_.size() + 1) / 2);
    const auto [least, most] = std::ranges::minmax(readings_, {}, time_of);
    // Room for marks; at least a factor of two.
    const double low = time_of(least) / 1.3, high = std::max(time_of(most) * 1.3, low * 2);
    text += fmt::format("set xrange [{}:{}]\n", low, high);
    for (size_t i = 0; i < kPanels.size(); ++i) text += panel(i, low, high);
    return text + "unset multiplot\n";
  }

 private:
  static double time_of(const BenchReading* r) { return r->time(BsdfCall::hit).mean; }

  /// Time, relative variance, their standard errors.
  std::string rows(size_t material, size_t angle, Worth SampleWorth::*worth) const {
    std::string text;
    for (size_t i = 0; i < readings_.size(); ++i) {
      const Worth& w = readings_[i]->worth.*worth;
      if (places_[i].material != material || places_[i].angle != angle || !(w.mean.mean > 0) || !(w.variance.mean > 0))
        continue;
      const double square = w.mean.mean * w.mean.mean;
      text += fmt::format("{} {} {} {}\n", time_of(readings_[i]), w.variance.mean / square,
                          readings_[i]->time(BsdfCall::hit).standard_error(), w.variance.standard_error() / square);
    }
    return text.empty() ? "NaN NaN NaN NaN\n" : text;
  }

  std::string panel(size_t number, double low, double high) const {
    const Panel& p = kPanels[number];
    std::string text, plots;
    double least = INFINITY, most = 0;
    for (const BenchReading* r : readings_) {
      const Worth& w = r->worth.*p.worth;
      const double v = w.variance.mean / (w.mean.mean * w.mean.mean);
      if (v > 0 && std::isfinite(v)) least = std::min(least, v), most = std::max(most, v);
    }
    if (most == 0) least = most = 1;
    // Whole decades, so that there is a tick at either end.
    const double bottom = std::pow(10, std::floor(std::log10(least / 1.5))),
                 top = std::pow(10, std::ceil(std::log10(most * 1.5)));
    text += fmt::format("set title {}\nset ylabel 'variance of one sample / mean²'\nset yrange [{}:{}]\n",
                        gnuplot_text(p.title), bottom, top);
    text += number == 0 ? "set key at screen 0.5,0.01 center bottom vertical Left reverse noenhanced maxrows " +
                              std::to_string((materials_.size() + angles_.size() + 2) / 2) + "\n"
                        : "unset key\n";
    for (size_t m = 0; m < materials_.size(); ++m)
      for (size_t a = 0; a < angles_.size(); ++a) {
        text += fmt::format("$p{}_{}_{} << EOD\n{}EOD\n", number, m, a, rows(m, a, p.worth));
        plots += fmt::format(
            ", $p{0}_{1}_{2} using 1:2:3:4 with xyerrorbars lc rgb '{3}' lw 1 pt 0 notitle, $p{0}_{1}_{2} using 1:2 "
            "with points lc rgb '{3}' pt {4} ps 0.9 notitle",
            number, m, a, kSeriesColors[m], kMarks[a]);
      }
    for (size_t m = 0; m < materials_.size(); ++m)
      plots += fmt::format(", NaN with points lc rgb '{}' pt 7 ps 1 title {}", kSeriesColors[m],
                           gnuplot_text(materials_[m], 60));
    for (size_t a = 0; a < angles_.size(); ++a)
      plots += fmt::format(", NaN with points lc rgb '#808080' pt {} ps 1 title '{:g}° from the normal'", kMarks[a],
                           angles_[a]);
    return text + "plot " + iso_lines(bottom * low, top * high) + plots + "\n";
  }

  /// Time x variance = 10^k.
  static std::string iso_lines(double least, double most) {
    std::string text;
    for (double k = std::floor(std::log10(least)); k <= std::ceil(std::log10(most)); ++k)
      text += fmt::format("{}1e{}/x with lines lc rgb '#a0a0a0' lw 1 dt 2 {}", text.empty() ? "" : ", ", int(k),
                          text.empty() ? "title 'time × variance alike'" : "notitle");
    return text;
  }

  std::vector<std::string> materials_;
  std::vector<double> angles_;
  std::vector<Place> places_;
  std::vector<const BenchReading*> readings_;
  std::string xlabel_;
};

}  // namespace

void check_bench_chart(size_t materials, size_t angles) {
  if (materials > kSeriesColors.size())
    fail({}, "--plot: {} materials are more than the {} colours that can be told apart", materials,
         kSeriesColors.size());
  if (angles > kMarks.size())
    fail({}, "--plot: {} angles are more than the {} marks that can be told apart", angles, kMarks.size());
}

std::string bench_chart(const std::vector<BenchReading>& readings) { return Scatter(readings).script(); }

}  // namespace frond
