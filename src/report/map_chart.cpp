#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "report/gnuplot.h"
#include "report/patch_charts.h"

namespace frond {
namespace {

constexpr size_t kMostReadings = 12;
constexpr size_t kMostCells = 100'000;
constexpr int kMapSize = 400, kTitleHeight = 40, kScaleWidth = 130;
constexpr double kDegree = std::numbers::pi / 180;

/// Blue to yellow by way of green, brighter all the way: readable without colour vision and in grey (viridis, by van
/// der Walt and Smith).
constexpr const char* kPalette =
    "set palette defined (0 '#440154', 1 '#472c7a', 2 '#3b518b', 3 '#2c718e', 4 '#21908d', 5 '#27ad81', 6 '#5cc863', 7 "
    "'#aadc32', 8 '#fde725')\n";

/// Columns of cells in a patch, so that its outer edge is round.
int cells_per_patch(const DetectorSphere& sphere) { return std::max(1, 48 / sphere.phis()); }

/// A line "x y f" for each corner of each cell, the cells' f at their first corner; the light comes from the left.
std::string map_data(const GoniophotometerReading& r, bool reflected) {
  const int thetas = r.sphere.thetas() / 2, per_patch = cells_per_patch(r.sphere), cells = r.sphere.phis() * per_patch;
  const bool lit_from_front = r.beam.theta_deg <= 90, front = reflected == lit_from_front;
  const double handed = lit_from_front ? -1 : 1;  // seen from behind, azimuths run the other way round
  std::string data;
  for (int row = 0; row <= thetas; ++row) {
    const int inner = std::min(row, thetas - 1), theta = front ? inner : r.sphere.thetas() - 1 - inner;
    const double radius = 90.0 * row / thetas;
    for (int cell = 0; cell <= cells; ++cell) {
      const double phi = r.sphere.patch(0, 0).phi_min_deg + 360.0 * cell / cells;
      const double f = r.f(r.sphere.index(theta, cell / per_patch % r.sphere.phis())).mean;
      fmt::format_to(std::back_inserter(data), "{:.6g} {:.6g} {}\n", -radius * std::cos(phi * kDegree),
                     handed * radius * std::sin(phi * kDegree), f);
    }
    data += '\n';
  }
  return data;
}

struct Range {
  double smallest = std::numeric_limits<double>::max(), largest = 0;  ///< of what is above 0
};

Range range_of(const std::vector<LabelledPatches>& readings) {
  Range range;
  for (const auto& [material, r] : readings)
    for (size_t i = 0; i < r.sphere.size(); ++i)
      if (const double f = r.f(i).mean; f > 0)
        range.smallest = std::min(range.smallest, f), range.largest = std::max(range.largest, f);
  return range.largest > 0 ? range : Range{1e-6, 1};
}

/// A logarithmic scale spans a decade at least, so that a number stands at it. What is 0 has the darkest colour.
std::string scale(const Range& range, bool logarithmic) {
  constexpr double kLeastSpan = 11;
  std::string script = kPalette;
  if (logarithmic)
    script += fmt::format("set logscale cb\nset cbrange [{}:{}]\n",
                          std::min(range.smallest, range.largest / kLeastSpan), range.largest);
  else
    script += fmt::format("set cbrange [0:{}]\n", range.largest);
  return script + "set cblabel 'f (sr⁻¹)'\n";
}

/// Circles and spokes over the map, with the angles from the normal that they stand for.
std::string graticule() {
  std::string script;
  for (const int radius : {30, 60, 90}) {
    script += fmt::format("set object {0} circle at 0,0 size {0} front fs empty border lc rgb '{1}' lw {2}\n", radius,
                          radius == 90 ? "#000000" : "#ffffff", radius == 90 ? 1 : 0.7);
    script += fmt::format("set label {0} '{0}°' at {1},{2} left front font ',9' textcolor rgb '{3}'\n", radius,
                          radius * 0.71 + 1, radius * 0.71 + 3, radius == 90 ? "#000000" : "#ffffff");
  }
  return script;
}

std::string mark(const GoniophotometerReading& r, bool reflected) {
  const double from_normal = std::min(r.beam.theta_deg, 180 - r.beam.theta_deg);
  const char* shape = "front point lw 1.5 lc rgb '#ffffff'";
  std::string script = fmt::format("set label 101 '' at {},0 {} pt 2 ps 1.2\n", from_normal, shape);
  if (reflected) script += fmt::format("set label 100 '' at {},0 {} pt 3 ps 1.6\n", -from_normal, shape);
  return reflected ? script : "unset label 100\n" + script;
}

/// Where charts of this many readings have what, as shares of the whole.
struct MapLayout {
  explicit MapLayout(size_t readings) : height(static_cast<int>(readings) * (kMapSize + kTitleHeight)) {}

  double x(double pixels) const { return pixels / width; }
  double y(double pixels_from_top) const { return 1 - pixels_from_top / height; }

  int width = 2 * kMapSize + kScaleWidth, height;
};

std::string hemisphere(const LabelledPatches& r, size_t i, bool reflected, const MapLayout& layout) {
  constexpr double kGap = 8;
  const double left = reflected ? kGap : kMapSize + kGap, top = double(i) * (kMapSize + kTitleHeight) + kTitleHeight;
  const double side = kMapSize - 2 * kGap;
  const Beam& beam = r.reading.beam;
  std::string script = fmt::format(
      "set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\nset bmargin at screen {}\n",
      layout.x(left), layout.x(left + side), layout.y(top), layout.y(top + side));
  const std::string light = fmt::format("BTDF, seen through: light at {:g}°, {:g} nm", beam.theta_deg, beam.lambda_nm);
  script += fmt::format("set title {} offset 0,-0.5\n", gnuplot_text(reflected ? "BRDF: " + r.material : light, 50));
  script += mark(r.reading, reflected);
  const bool has_scale = i == 0 && !reflected;
  script += has_scale ? fmt::format("set colorbox user origin {},{} size {},{}\n", layout.x(2 * kMapSize + 10),
                                    layout.y(kTitleHeight + 0.9 * side), layout.x(20), 0.8 * side / layout.height)
                      : "unset colorbox\n";
  return script + fmt::format("splot ${}{} using 1:2:(0):3 with pm3d notitle\n", reflected ? 'r' : 't', i);
}

}  // namespace

void check_map_chart(const ReadingCounts& c, const DetectorSphere& sphere) {
  const size_t readings = c.materials * c.angles * c.wavelengths;
  if (readings > kMostReadings)
    fail({}, "--map draws {} readings at most, {} were asked for ({} materials, {} angles, {} wavelengths)",
         kMostReadings, readings, c.materials, c.angles, c.wavelengths);
  if (sphere.size() > kMostCells)
    fail({}, "--map draws {} patches at most, there are {} x {}", kMostCells, sphere.thetas(), sphere.phis());
}

Chart map_chart(const std::vector<LabelledPatches>& readings, bool logarithmic) {
  const MapLayout layout(readings.size());
  std::string script;
  for (size_t i = 0; i < readings.size(); ++i)
    for (const bool reflected : {true, false})
      script +=
          fmt::format("${}{} << EOD\n{}EOD\n", reflected ? 'r' : 't', i, map_data(readings[i].reading, reflected));
  script +=
      "set multiplot\nset view map\nset pm3d corners2color c1 border retrace\nunset key\nunset tics\nset cbtics\nunset "
      "border\nset xrange [-92:92]\nset yrange [-92:92]\n";
  script += scale(range_of(readings), logarithmic) + graticule();
  for (size_t i = 0; i < readings.size(); ++i)
    for (const bool reflected : {true, false}) script += hemisphere(readings[i], i, reflected, layout);
  return {layout.width, layout.height, script + "unset multiplot\n"};
}

}  // namespace frond
