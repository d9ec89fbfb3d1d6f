#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/error.h"
#include "report/gnuplot.h"
#include "report/share_tables.h"

namespace frond {
namespace {

/// One colour: a material under all values of what the chart is drawn against.
struct Curve {
  std::string title, data;
};

size_t distinct(const std::vector<LabelledReading>& readings, double Beam::*coordinate) {
  std::map<double, int> values;
  for (const auto& r : readings) ++values[r.reading.beam.*coordinate];
  return values.size();
}

std::pair<double, double> extent(const std::vector<LabelledReading>& readings, double Beam::*coordinate) {
  const auto [low, high] =
      std::ranges::minmax(readings, {}, [coordinate](const LabelledReading& r) { return r.reading.beam.*coordinate; });
  return {low.reading.beam.*coordinate, high.reading.beam.*coordinate};
}

std::string title_of(const LabelledReading& r, bool by_wavelength, bool alone) {
  if (alone) return r.material;
  const Beam& beam = r.reading.beam;
  return by_wavelength ? fmt::format("{}, {:.6g}°", r.material, beam.theta_deg)
                       : fmt::format("{}, {:.6g} nm", r.material, beam.lambda_nm);
}

std::vector<Curve> curves_of(const std::vector<LabelledReading>& readings, bool by_wavelength, bool alone) {
  std::vector<Curve> curves;
  std::map<std::string, size_t> place;
  for (const LabelledReading& r : readings) {
    const std::string title = title_of(r, by_wavelength, alone);
    const auto [it, is_new] = place.emplace(title, curves.size());
    if (is_new) curves.push_back({title, ""});
    const SpectrophotometerReading& v = r.reading;
    curves[it->second].data +=
        fmt::format("{} {} {} {} {}\n", by_wavelength ? v.beam.lambda_nm : v.beam.theta_deg, v.reflectance.mean,
                    v.reflectance.standard_error(), 1 - v.transmittance.mean, v.transmittance.standard_error());
  }
  return curves;
}

constexpr const char* kAxes = R"(set yrange [0:1]
set y2range [1:0]
set ytics nomirror 0.1
set y2tics 0.1
set ylabel 'reflectance R (from below)'
set y2label 'transmittance T (from above)'
set grid lc rgb '#d0d0d0' lw 0.5
set lmargin 9
set rmargin 9
)";

/// The key stands below the axes in two columns; each row of it is kept free there.
std::string key_below(size_t entries) {
  const size_t rows = (entries + 1) / 2;
  return fmt::format("set bmargin {}\nset key at screen 0.5,0.01 center bottom vertical Left reverse maxrows {}\n",
                     rows + 4, rows);
}

/// Points where they stand apart, lines and bars alone where there are many.
double point_size(size_t readings_per_curve) { return readings_per_curve <= 40 ? 0.5 : 0; }

/// A line, its points and a bar of a standard error each way; the value is in `column` of the data, its error in the
/// next. (Gnuplot's own error bars would rub out lines behind them.)
std::string curve(size_t i, int column, const std::string& line, double size) {
  const std::string data = fmt::format("$d{} using 1:", i), color = fmt::format("lc rgb '{}'", kSeriesColors[i]);
  return fmt::format(
      "{0}{2} with lines {1} lw 1.5 {4}, {0}{2} with points {1} pt 7 ps {5} notitle, "
      "{0}(${2} - ${3}):(0):(2 * ${3}) with vectors nohead {1} lw 1.5 notitle, ",
      data, color, column, column + 1, line, size);
}

}  // namespace

void check_shares_chart(size_t materials, size_t angles, size_t wavelengths) {
  const size_t along = std::max(angles, wavelengths), curves = materials * std::min(angles, wavelengths);
  if (along < 2) fail({}, "--plot draws R and T against wavelength or angle: two values of one at least are needed");
  if (curves > kSeriesColors.size())
    fail({},
         "--plot: {} curves ({} materials, {} angles, {} wavelengths) are more than the {} colours that can be told "
         "apart",
         curves, materials, angles, wavelengths, kSeriesColors.size());
}

std::string shares_chart(const std::vector<LabelledReading>& readings) {
  const size_t angles = distinct(readings, &Beam::theta_deg), wavelengths = distinct(readings, &Beam::lambda_nm);
  const bool by_wavelength = wavelengths >= angles;
  const auto curves = curves_of(readings, by_wavelength, std::min(angles, wavelengths) == 1);
  check_shares_chart(curves.size() / std::min(angles, wavelengths), angles, wavelengths);
  std::string script;
  for (size_t i = 0; i < curves.size(); ++i) script += fmt::format("$d{} << EOD\n{}EOD\n", i, curves[i].data);
  script += kAxes + key_below(curves.size() + 2);
  const auto [first, last] = extent(readings, by_wavelength ? &Beam::lambda_nm : &Beam::theta_deg);
  script += fmt::format("set xrange [{}:{}]\nset xlabel '{}'\nplot ", first, last,
                        by_wavelength ? "wavelength (nm)" : "angle of incidence (degrees)");
  const double size = point_size(std::max(angles, wavelengths));
  for (size_t i = 0; i < curves.size(); ++i)
    script +=
        curve(i, 2, fmt::format("title {}", gnuplot_text(curves[i].title)), size) + curve(i, 4, "dt 2 notitle", size);
  return script +
         "NaN with lines lc rgb '#808080' lw 1.5 title 'R', NaN with lines lc rgb '#808080' lw 1.5 dt 2 title "
         "'1 − T'\n";
}

}  // namespace frond
