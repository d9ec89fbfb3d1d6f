#include "jobs/support/canopy_files.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "core/math/vec.h"
#include "scene/format/plugin_text.h"
#include "system/file_bytes.h"
#include "system/text_table.h"

namespace frond {
namespace {

constexpr double kRightAngle = 90;

constexpr Param kEllipsoidalParams[] = {
    {.name = "chi", .kind = ParamKind::real, .range = {kLeastChi, kMostChi}, .doc = "Horizontal over vertical axis."},
    {.name = "mean", .kind = ParamKind::real, .unit = "degrees", .range = {0, 90}, .doc = "Mean inclination."},
};
/// Beyond this range nearly all leaves have one angle.
constexpr Interval kBetaRange{0.01, 1000};
constexpr Param kBetaParams[] = {
    {.name = "mu", .kind = ParamKind::real, .range = kBetaRange, .doc = "Exponent of vertical leaves."},
    {.name = "nu", .kind = ParamKind::real, .range = kBetaRange, .doc = "Exponent of horizontal leaves."},
};
/// Records of the distributions with parameters, so that the parser of plug-ins checks names and types.
constexpr PluginInfo kEllipsoidal{"distribution", "ellipsoidal", "", "Campbell 1990", kEllipsoidalParams};
constexpr PluginInfo kBeta{"distribution", "beta", "", "Goel and Strebel 1984", kBetaParams};

/// Returns the given values by name, each a number in its range. Throws InputError.
std::vector<std::optional<double>> numbers_of(const PluginText& text, const PluginInfo& info) {
  ParsedPlugin plugin{text.name, text.where, {}};
  set_params(text, info, text.where, plugin);
  std::vector<std::optional<double>> values;
  for (const Param& declared : info.params) {
    values.emplace_back();
    const ParsedParam* param = find_param(plugin.params, declared.name);
    if (!param) continue;
    const auto& given = std::get<std::vector<double>>(param->values);
    if (given.size() != 1 || !(given[0] >= declared.range.min && given[0] <= declared.range.max))
      fail(text.where, "\"{}\" of \"{}\" is one number from {:g} to {:g}, {:g} was given", declared.name, info.name,
           declared.range.min, declared.range.max, fmt::join(given, ","));
    values.back() = given[0];
  }
  return values;
}

/// Returns a number of a row. Throws InputError for text that is no number, and beyond the lengths of a canopy.
double number_at(const TextTable& table, size_t field, std::string_view name) {
  constexpr double kMost = 1e9;
  const std::string_view word = table.fields()[field].text;
  const auto value = table.number(word);
  if (!value || !(std::abs(*value) <= kMost))
    fail(table.where(field), "the column {} needs a number from {:g} to {:g}, \"{}\" was given", name, -kMost, kMost,
         word);
  return *value;
}

/// Reads a table with two columns as points of a density; the first column must not descend, and may repeat a value:
/// a step. The names `first` and `second` are those of messages; the file may have any. Columns of row numbers and of
/// standard errors, NAME_se, are passed over. Throws InputError.
std::vector<DensityTable::Point> read_points(const std::string& path, std::string_view first, std::string_view second) {
  const std::string text = read_file_bytes(path, {});
  TextTable table(text, path, TableComments::anywhere);
  const size_t rows_named = table.has_names() && table.names()[0].text.empty() ? 1 : 0;
  const bool has_errors = table.has_names() && table.names().back().text.ends_with("_se");
  if (table.columns() != rows_named + (has_errors ? 3 : 2))
    fail(table.names_where(), "two columns are needed, {} and {}; the file has {}", first, second, table.columns());
  std::vector<DensityTable::Point> points;
  while (table.next()) {
    table.check_fields();
    const DensityTable::Point p{number_at(table, rows_named, first), number_at(table, rows_named + 1, second)};
    if (!points.empty() && p.at < points.back().at)
      fail(table.where(rows_named), "the column {} must ascend: {:g} follows {:g}", first, p.at, points.back().at);
    if (p.density < 0) fail(table.where(rows_named + 1), "the column {} is below 0: {:g}", second, p.density);
    points.push_back(p);
  }
  if (points.size() < 2) fail(table.names_where(), "at least two rows are needed, the file has {}", points.size());
  return points;
}

/// Returns the density as steps if the angles are the middles of classes that fill 0 to 90 degrees without gaps, and
/// the frequencies their shares; else nothing. The first class begins at 0, so that each middle gives the end of its
/// class: classes may have different widths, as those of SCOPE.
std::vector<DensityTable::Point> steps_of_classes(const std::vector<DensityTable::Point>& classes) {
  constexpr double kSlack = 1e-3;  // degrees for each class; middles are often rounded
  std::vector<DensityTable::Point> steps;
  double begin = 0;
  for (const auto& [middle, share] : classes) {
    const double end = 2 * middle - begin;
    if (!(end > begin)) return {};
    steps.push_back({begin, share / (end - begin)});
    steps.push_back({end, share / (end - begin)});
    begin = end;
  }
  return std::abs(begin - kRightAngle) <= kSlack * double(classes.size()) ? steps : std::vector<DensityTable::Point>{};
}

/// Reads classes or points. Points must span 0 to 90 degrees: of a table that ends earlier it is unknown whether it
/// holds points or middles of classes. Throws InputError.
LeafAngles read_angles(const std::string& path) {
  std::vector<DensityTable::Point> points = read_points(path, "angle", "frequency");
  const Location where{std::make_shared<const std::string>(path)};
  if (auto steps = steps_of_classes(points); !steps.empty()) {
    points = std::move(steps);
  } else if (points.front().at != 0 || points.back().at != kRightAngle) {
    fail(where,
         "the angles run from {:g} to {:g}: they are either points from 0 to 90 degrees, between which the density is "
         "linear, or the middles of classes that fill 0 to 90 degrees, as 5, 15, ..., 85",
         points.front().at, points.back().at);
  }
  for (auto& [at, density] : points) at *= kDegree;
  const DensityTable table(std::move(points));
  if (!(table.integral() > 0)) fail(where, "all frequencies are 0");
  return tabulated_angles(std::filesystem::path(path).filename().string(), table);
}

/// Rows of a table of crowns. Columns are found by their names, in any order; unknown names are errors, because a
/// misspelled optional column would have no effect.
class CrownRows {
 public:
  /// Throws InputError for names that are unknown, missing or there twice.
  CrownRows(std::string_view text, const std::string& path) : table_(text, path) {
    constexpr std::string_view kNames[] = {"x", "y", "z", "base", "radius", "rx", "ry", "rz", "shape", "density"};
    const std::vector<std::string_view> known(std::begin(kNames), std::end(kNames));
    if (!table_.has_names())
      fail(table_.names_where(), "the first line names the columns: {}", fmt::join(kNames, ", "));
    for (size_t i = 0; i < table_.names().size(); ++i) {
      names_.push_back(name_without_unit(table_.names()[i].text));
      if (names_[i].empty()) continue;
      if (std::ranges::find(known, names_[i]) == known.end())
        fail(table_.names_where(i), "unknown column \"{}\"{}", names_[i], suggestion(names_[i], known));
      if (std::ranges::find(names_, names_[i]) != names_.end() - 1)
        fail(table_.names_where(i), "there are two columns \"{}\"", names_[i]);
    }
    if (!column("x") || !column("y") || column("z").has_value() == column("base").has_value())
      fail(table_.names_where(),
           "columns x, y and either z, of a crown's middle, or base, of its lowest point, are needed");
    if (!column("radius") && !(column("rx") && column("ry") && column("rz")))
      fail(table_.names_where(), "the column radius is needed, or rx, ry and rz, which is half of the height");
  }

  /// Reads the next row. Returns false at the end. Throws InputError for missing fields.
  bool next() {
    if (!table_.next()) return false;
    table_.check_fields();
    return true;
  }
  /// Throws InputError for a radius or density that is not above 0, and for an unknown shape.
  Crown crown() const {
    Crown crown{.centre = {number("x"), number("y"), 0}, .radii = {size("rx"), size("ry"), size("rz")}};
    crown.centre.z = column("z") ? number("z") : number("base") + crown.radii.z;
    if (column("density")) crown.density = above_zero("density");
    if (const auto i = column("shape")) crown.shape = shape_of(*i);
    return crown;
  }
  Location names_where() const { return table_.names_where(); }

 private:
  /// Returns the index of a column; nullopt if the table lacks it.
  std::optional<size_t> column(std::string_view name) const {
    const auto found = std::ranges::find(names_, name);
    return found == names_.end() ? std::nullopt : std::optional(size_t(found - names_.begin()));
  }
  double number(std::string_view name) const { return number_at(table_, *column(name), name); }
  double above_zero(std::string_view name) const {
    const double value = number(name);
    if (!(value > 0)) fail(table_.where(*column(name)), "the column {} is not above 0: {:g}", name, value);
    return value;
  }
  /// Returns a half axis: its own column, else the common radius.
  double size(std::string_view axis) const { return above_zero(column(axis) ? axis : "radius"); }
  Crown::Shape shape_of(size_t column) const {
    const std::vector<std::string_view> shapes{"ellipsoid", "cone", "cylinder"};
    const std::string word = lower_case(table_.fields()[column].text);
    const auto found = std::ranges::find(shapes, word);
    if (found == shapes.end())
      fail(table_.where(column), "unknown shape \"{}\" of a crown{}", word, suggestion(word, shapes));
    return Crown::Shape(found - shapes.begin());
  }

  TextTable table_;
  std::vector<std::string> names_;  ///< lower case, without units
};

}  // namespace

/// A word with parameters is never taken as a file, unless there is one, so that a misspelled name is reported as such.
LeafAngles leaf_angles_of(const std::string& text, const std::string& option) {
  const PluginText word = parse_plugin_text(text, {std::make_shared<const std::string>(option)});
  const auto named = std::ranges::find(leaf_angle_distributions(), word.name, &LeafAngles::name);
  if (named != leaf_angle_distributions().end() && !word.params.empty())
    fail(word.where, "\"{}\" has no parameters", word.name);
  if (named != leaf_angle_distributions().end()) return *named;
  if (word.name == kEllipsoidal.name) {
    const auto values = numbers_of(word, kEllipsoidal);
    if (values[0].has_value() == values[1].has_value())
      fail(word.where, "\"{}\" needs either mean, in degrees, or chi: {},mean=57.3", word.name, word.name);
    return ellipsoidal_angles(values[0] ? *values[0] : chi_of_mean(*values[1] * kDegree));
  }
  if (word.name == kBeta.name) {
    const auto values = numbers_of(word, kBeta);
    if (!values[0] || !values[1]) fail(word.where, "\"{}\" needs mu and nu: {},mu=2.77,nu=1.17", word.name, word.name);
    return beta_angles(*values[0], *values[1]);
  }
  const bool is_file_name = word.params.empty() && std::filesystem::path(text).has_extension();
  if (is_file_name || std::filesystem::exists(text)) return read_angles(text);
  std::vector<std::string_view> names{kEllipsoidal.name, kBeta.name};
  for (const LeafAngles& a : leaf_angle_distributions()) names.push_back(a.name);
  fail(word.where, "\"{}\" is neither a file nor a distribution{}", word.name, suggestion(word.name, names));
}

DensityTable read_profile(const std::string& path) {
  DensityTable table(read_points(path, "height", "density"));
  if (!(table.integral() > 0))
    fail({std::make_shared<const std::string>(path)}, "the leaf area density is 0 everywhere");
  return table;
}

std::vector<Crown> read_crowns(const std::string& path) {
  const std::string text = read_file_bytes(path, {});
  CrownRows rows(text, path);
  std::vector<Crown> crowns;
  while (rows.next()) crowns.push_back(rows.crown());
  if (crowns.empty()) fail(rows.names_where(), "the file has no rows, only the names of columns");
  return crowns;
}

}  // namespace frond
