#include "report/brf_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/error.h"
#include "report/gnuplot.h"

namespace frond {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Bands that differ by more than this have no room on one even scale.
constexpr double kLogarithmic = 8;

/// The largest value over the smallest.
double spread(const BrfReading& reading) {
  const auto [least, most] = std::ranges::minmax(reading.values, {}, &MeanError::mean);
  return least.mean > 0 ? most.mean / least.mean : 1;
}

std::string wavelength(double nm) { return fmt::format("{:g} nm", nm); }

/// Blue to yellow by way of green (viridis, by van der Walt and Smith).
constexpr const char* kPalette =
    "set palette defined (0 '#440154', 1 '#472c7a', 2 '#3b518b', 3 '#2c718e', 4 '#21908d', 5 '#27ad81', 6 '#5cc863', 7 "
    "'#aadc32', 8 '#fde725')\n";

/// The BRF at a view of a ring; between views of the ring that are there, linear.
class Rings {
 public:
  Rings(const BrfReading& reading, size_t band) {
    for (size_t i = 0; i < reading.views.size(); ++i)
      rings_[reading.views[i].zenith_deg][std::fmod(reading.views[i].azimuth_deg + 360, 360)] =
          reading.at(i, band).mean;
  }
  /// Azimuths go round.
  double at(double zenith, double azimuth) const {
    const auto above = rings_.lower_bound(zenith);
    const auto upper = above == rings_.end() ? std::prev(above) : above;
    const auto lower = upper == rings_.begin() || upper->first <= zenith ? upper : std::prev(upper);
    const double t = upper == lower ? 0 : (zenith - lower->first) / (upper->first - lower->first);
    return std::lerp(on_ring(lower->second, azimuth), on_ring(upper->second, azimuth), t);
  }
  double largest_zenith() const { return rings_.rbegin()->first; }

 private:
  static double on_ring(const std::map<double, double>& ring, double azimuth) {
    const auto next = ring.upper_bound(azimuth);
    const auto b = next == ring.end() ? ring.begin() : next,
               a = next == ring.begin() ? std::prev(ring.end()) : std::prev(next);
    const double width = b->first - a->first + (b->first <= a->first ? 360 : 0);
    const double way = azimuth - a->first + (azimuth < a->first ? 360 : 0);
    return std::lerp(a->second, b->second, way / width);
  }

  std::map<double, std::map<double, double>> rings_;
};

/// Corners of cells, "x y value", the sun on the left: azimuth 0 lies on the right.
std::string map_data(const Rings& rings) {
  constexpr int kCells = 120, kZeniths = 45;
  std::string data;
  for (int i = 0; i <= kZeniths; ++i) {
    const double zenith = rings.largest_zenith() * i / kZeniths;
    for (int k = 0; k <= kCells; ++k) {
      const double azimuth = 360.0 * k / kCells;
      fmt::format_to(std::back_inserter(data), "{:.5g} {:.5g} {:.6g}\n", zenith * std::cos(azimuth * kDegree),
                     zenith * std::sin(azimuth * kDegree), rings.at(zenith, std::fmod(azimuth, 360)));
    }
    data += '\n';
  }
  return data;
}

}  // namespace

BrfChart brf_plane_chart(const BrfReading& reading) {
  std::string script =
      "set xlabel 'zenith angle of the view (degrees)'\nset ylabel 'BRF'\nset xtics 15\nset mxtics 3\n"
      "set key outside right top\nset grid lc rgb '#d0d0d0' lw 0.5\n";
  // A plane for each azimuth that is there.
  std::map<double, std::vector<size_t>> planes;
  for (size_t i = 0; i < reading.views.size(); ++i) planes[reading.views[i].azimuth_deg].push_back(i);
  script += spread(reading) > kLogarithmic ? "set logscale y\nset yrange [*:*]\n" : "set yrange [0:*]\n";
  std::string plots;
  size_t curve = 0;
  for (const auto& [azimuth, views] : planes)
    for (size_t band = 0; band < reading.wavelengths_nm.size(); ++band, ++curve) {
      script += fmt::format("$c{} << EOD\n", curve);
      for (const size_t i : views)
        script += fmt::format("{} {} {}\n", reading.views[i].zenith_deg, reading.at(i, band).mean,
                              reading.at(i, band).standard_error);
      script += "EOD\n";
      const std::string title =
          wavelength(reading.wavelengths_nm[band]) + (planes.size() > 1 ? fmt::format(", {:g}°", azimuth) : "");
      const std::string_view color = kSeriesColors[curve % kSeriesColors.size()];
      plots += fmt::format(
          "{0}$c{1} with lines lw 2 lc rgb '{2}' title {3}, $c{1} with yerrorbars pt 7 ps 0.4 lw 1 lc rgb '{2}' "
          "notitle",
          plots.empty() ? "plot " : ", ", curve, color, gnuplot_text(title));
    }
  return {script + plots + "\n", 900, 560};
}

BrfChart brf_hemisphere_chart(const BrfReading& reading) {
  constexpr size_t kMost = 12;
  const size_t bands = reading.wavelengths_nm.size();
  if (bands > kMost) fail({}, "--plot has room for {} maps, these are {} wavelengths", kMost, bands);
  const int columns = int(std::min<size_t>(bands, 3)), rows = (int(bands) + columns - 1) / columns;
  std::string script = fmt::format("set multiplot layout {},{}\n{}", rows, columns, kPalette);
  script +=
      "set size ratio -1\nset pm3d map corners2color mean\nunset key\nunset border\nunset tics\nset cbtics\n"
      "set xrange [-92:92]\nset yrange [-92:92]\n"
      "set cbrange [*:*]\n";
  for (const int radius : {30, 60, 90})
    script += fmt::format(
        "set object {0} circle at 0,0 size {0} front fs empty border lc rgb '#ffffff' lw 0.7\n"
        "set label {0} '{0}°' at 1,{1} left front font ',9' textcolor rgb '{2}'\n",
        radius, radius - 6, radius == 90 ? "#000000" : "#ffffff");
  for (size_t band = 0; band < bands; ++band) {
    const int column = int(band) % columns, row = int(band) / columns;
    const double left = double(column) / columns, bottom = 1 - double(row + 1) / rows;
    script += fmt::format("set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\n", left + 0.02 / columns,
                          left + 0.80 / columns);
    script += fmt::format("set bmargin at screen {:.4f}\nset tmargin at screen {:.4f}\n", bottom + 0.03 / rows,
                          bottom + 0.89 / rows);
    script += fmt::format("$m{} << EOD\n{}EOD\nset title {}\n", band, map_data(Rings(reading, band)),
                          gnuplot_text("BRF at " + wavelength(reading.wavelengths_nm[band])));
    script += fmt::format("splot $m{} using 1:2:3 with pm3d\n", band);
  }
  return {script + "unset multiplot\n", 420 * columns, 380 * rows};
}

}  // namespace frond
