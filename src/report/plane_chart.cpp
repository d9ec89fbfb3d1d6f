#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "report/gnuplot.h"
#include "report/patch_charts.h"

namespace frond {
namespace {

constexpr size_t kMostAngles = 6, kMostMaterials = 4;
constexpr int kPanelWidth = 420, kPanelHeight = 320, kKeyLine = 20, kMarginAbove = 10;

// Vertical lines. gnuplot's SVG joins arrows of one colour into one path with one dash: these two differ by a step of
// grey that nobody sees.
constexpr std::string_view kTowardLight = "lc rgb '#808080' dt 3", kMirror = "lc rgb '#808081' dt 1";

/// The values that occur, each once, in the order of the readings.
template <class T, class Get>
std::vector<T> distinct(const std::vector<LabelledPatches>& readings, const Get& get) {
  std::vector<T> values;
  for (const LabelledPatches& r : readings)
    if (std::ranges::find(values, get(r)) == values.end()) values.push_back(get(r));
  return values;
}

template <class T>
size_t place(const std::vector<T>& values, const T& value) {
  return static_cast<size_t>(std::ranges::find(values, value) - values.begin());
}

struct Layout {
  explicit Layout(const std::vector<LabelledPatches>& r)
      : materials(distinct<std::string>(r, [](const auto& x) { return x.material; })),
        angles(distinct<double>(r, [](const auto& x) { return x.reading.beam.theta_deg; })),
        wavelengths(distinct<double>(r, [](const auto& x) { return x.reading.beam.lambda_nm; })),
        some_integrated(std::ranges::any_of(r, [](const auto& x) { return x.reading.is_integrated(); })) {}

  /// Wavelengths and what the vertical lines are stand side by side, materials under them.
  int upper_key_height() const { return kKeyLine * static_cast<int>(std::max<size_t>(wavelengths.size(), 2)); }
  int lower_key_height() const { return kKeyLine * static_cast<int>(materials.size()) + kMarginAbove; }
  int key_height() const { return upper_key_height() + lower_key_height() + kMarginAbove; }
  int width() const { return std::max<int>(2 * kPanelWidth, kPanelWidth * static_cast<int>(angles.size())); }
  int height() const { return 2 * kPanelHeight + key_height(); }

  std::vector<std::string> materials;
  std::vector<double> angles, wavelengths;
  bool some_integrated;  ///< curves without noise: what rays have measured are points and bars about them
};

/// A line "angle f se" for each patch in the plane of incidence. The angle is from the normal of that side, negative on
/// the light's side.
std::string plane_data(const GoniophotometerReading& r, bool reflected) {
  std::vector<std::pair<double, std::string>> lines;
  for (const int column : {0, r.sphere.phis() / 2})
    for (int row = 0; row < r.sphere.thetas(); ++row) {
      const Patch p = r.sphere.patch(row, column);
      if (r.is_reflected(p) != reflected) continue;
      const double from_normal = std::min(p.theta_deg(), 180 - p.theta_deg()),
                   angle = column == 0 ? -from_normal : from_normal;
      const Estimate f = r.f(r.sphere.index(row, column));
      lines.emplace_back(angle, fmt::format("{} {} {}\n", angle, f.mean, f.standard_error()));
    }
  std::ranges::sort(lines, {}, [](const auto& line) { return line.first; });
  std::string data;
  for (const auto& line : lines) data += line.second;
  return data;
}

double largest_in_plane(const std::vector<LabelledPatches>& readings, bool reflected) {
  double largest = 0;
  for (const auto& [material, r] : readings)
    for (const int column : {0, r.sphere.phis() / 2})
      for (int row = 0; row < r.sphere.thetas(); ++row)
        if (r.is_reflected(r.sphere.patch(row, column)) == reflected)
          largest = std::max(largest, r.f(r.sphere.index(row, column)).mean);
  return largest > 0 ? largest : 1;
}

std::string dash(size_t material) {
  constexpr std::array<const char*, kMostMaterials> kDashes{"1", "'-'", "'.'", "'_.'"};
  return kDashes[material % kDashes.size()];
}

int point(size_t material) {
  constexpr std::array<int, kMostMaterials> kPoints{7, 6, 5, 4};
  return kPoints[material % kPoints.size()];
}

std::string curve(const LabelledPatches& measured, const Layout& layout, size_t reading, bool reflected) {
  const size_t material = place(layout.materials, measured.material);
  const bool exact = measured.reading.is_integrated();
  const std::string data = fmt::format("${}{}", reflected ? 'r' : 't', reading),
                    color = fmt::format("lc rgb '{}'",
                                        kSeriesColors[place(layout.wavelengths, measured.reading.beam.lambda_nm)]);
  std::string script;
  if (exact || !layout.some_integrated)
    script += fmt::format("{} using 1:2 with lines {} lw 1.5 dt {} notitle, ", data, color, dash(material));
  if (!exact)
    script += fmt::format(
        "{0} using 1:2 with points {1} pt {2} ps 0.6 notitle, "
        "{0} using 1:($2 - $3):(0):(2 * $3) with vectors nohead {1} lw 1.5 notitle, ",
        data, color, point(material));
  return script;
}

std::string vertical_line(double angle_deg, std::string_view style) {
  return fmt::format("set arrow from {0}, graph 0 to {0}, graph 1 nohead {1}\n", angle_deg, style);
}

std::string panel(const std::vector<LabelledPatches>& readings, const Layout& layout, size_t column, bool reflected) {
  const double theta = layout.angles[column], from_normal = std::min(theta, 180 - theta);
  const double panel_height = double(kPanelHeight) / layout.height(), panel_width = 1.0 / double(layout.angles.size());
  std::string script = fmt::format("set origin {},{}\nset size {},{}\n", double(column) * panel_width,
                                   reflected ? 1 - panel_height : 1 - 2 * panel_height, panel_width, panel_height);
  script +=
      fmt::format("set title '{} light at θ = {:g}°'\nset xlabel '{}'\n", reflected ? "Reflected," : "Transmitted,",
                  theta, "angle from the normal (°), light’s side negative");
  script += fmt::format("set ylabel '{} (sr⁻¹)' offset 0.5\nset yrange [0:{}]\n", reflected ? "BRDF" : "BTDF",
                        1.08 * largest_in_plane(readings, reflected));
  script += "unset arrow\n";
  if (reflected) script += vertical_line(-from_normal, kTowardLight);
  script += vertical_line(from_normal, kMirror);
  script += "plot ";
  for (size_t i = 0; i < readings.size(); ++i)
    if (readings[i].reading.beam.theta_deg == theta) script += curve(readings[i], layout, i, reflected);
  return script + "NaN notitle\n";
}

constexpr const char* kNoAxes =
    "unset title\nunset xlabel\nunset ylabel\nunset tics\nunset border\nunset grid\nunset arrow\nset lmargin 0\nset "
    "rmargin 0\nset tmargin 0\nset bmargin 0\nset xrange [0:1]\nset yrange [0:1]\nset key at graph 0,1 left top Left "
    "reverse samplen 4\n";

/// A block of the key: a panel that has nothing else, its left end a share of the chart's width, its top in pixels from
/// the chart's lower edge.
std::string key_block(const Layout& layout, double left, int top, const std::vector<std::string>& entries) {
  std::string script =
      fmt::format("set origin {},0\nset size {},{}\nplot ", left, 1 - left, double(top) / layout.height());
  for (const std::string& entry : entries) script += "NaN with " + entry + ", ";
  return script + "NaN notitle\n";
}

/// How a material is drawn, for the key.
std::string stroke(const Layout& layout, const std::vector<LabelledPatches>& readings, size_t material) {
  const auto& reading = std::ranges::find(readings, layout.materials[material], &LabelledPatches::material)->reading;
  const std::string line = fmt::format("lw 1.5 dt {}", dash(material)),
                    mark = fmt::format("pt {} ps 0.6", point(material));
  if (reading.is_integrated()) return "lines lc rgb '#404040' " + line;
  if (layout.some_integrated) return "points lc rgb '#404040' " + mark;
  return "linespoints lc rgb '#404040' " + line + " " + mark;
}

std::string key(const Layout& layout, const std::vector<LabelledPatches>& readings) {
  std::vector<std::string> colors, strokes;
  for (size_t i = 0; i < layout.wavelengths.size(); ++i)
    colors.push_back(fmt::format("lines lc rgb '{}' lw 2 title '{:g} nm'", kSeriesColors[i], layout.wavelengths[i]));
  for (size_t i = 0; i < layout.materials.size(); ++i)
    strokes.push_back(stroke(layout, readings, i) + " title " + gnuplot_text(layout.materials[i]));
  const int upper = layout.upper_key_height() + layout.lower_key_height();
  return kNoAxes + key_block(layout, 0.05, upper, colors) +
         key_block(layout, 0.35, upper,
                   {fmt::format("lines {} title 'toward the light'", kTowardLight),
                    fmt::format("lines {} title 'mirror direction, or straight on'", kMirror)}) +
         key_block(layout, 0.05, layout.lower_key_height(), strokes);
}

}  // namespace

void check_plane_chart(const ReadingCounts& c, const DetectorSphere& sphere) {
  if (sphere.phis() % 2 != 0)
    fail({}, "--plot: with {} patches in phi none is centred across from the light; an even number is needed",
         sphere.phis());
  if (c.wavelengths > kSeriesColors.size() || c.materials > kMostMaterials || c.angles > kMostAngles)
    fail({}, "--plot holds {} wavelengths, {} materials and {} angles at most; {}, {} and {} were given",
         kSeriesColors.size(), kMostMaterials, kMostAngles, c.wavelengths, c.materials, c.angles);
}

Chart plane_chart(const std::vector<LabelledPatches>& readings) {
  const Layout layout(readings);
  std::string script;
  for (size_t i = 0; i < readings.size(); ++i)
    for (const bool reflected : {true, false})
      script +=
          fmt::format("${}{} << EOD\n{}EOD\n", reflected ? 'r' : 't', i, plane_data(readings[i].reading, reflected));
  script +=
      "set multiplot\nset grid lc rgb '#d0d0d0' lw 0.5\nset xrange [-90:90]\nset xtics 30\nset lmargin 10\nset rmargin "
      "3\nunset key\n";
  for (size_t column = 0; column < layout.angles.size(); ++column)
    script += panel(readings, layout, column, true) + panel(readings, layout, column, false);
  script += key(layout, readings) + "unset multiplot\n";
  return {layout.width(), layout.height(), script};
}

}  // namespace frond
