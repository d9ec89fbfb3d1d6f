#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/math/vec.h"
#include "jobs/record/common_params.h"
#include "scene/geometry/instance_writer.h"
#include "system/file_bytes.h"
#include "system/text_table.h"

namespace frond {

// `frond instances`: instance table from a CSV file.

namespace {

using enum ArgumentKind;

constexpr JobParam kInstancesParams[] = {
    JobParam("csv", text, "CSV file to read.",
             {.type = "FILE", .path = PathUse::read, .positional = true, .required = true}),
    output_param("Instance table to write, a NumPy file (.npy).", true),
};

/// A table of numbers, read row by row.
class NumberTable {
 public:
  explicit NumberTable(const std::string& path)
      : text_(read_file_bytes(path, {})), start_(text_, path, TableComments::anywhere), rows_(start_) {
    if (rows_.columns() == 0) fail(rows_.names_where(), "the file is empty: its first line names the columns");
    for (const TableField& field : rows_.names()) names_.emplace_back(field.text);
    if (rows_.has_names()) return;
    if (rows_.columns() != std::size(kLeafCloud))
      fail(rows_.names_where(),
           "the first line holds {} numbers, it names the columns; without names, a leaf cloud of Eradiate or RAMI has "
           "the {} columns {}",
           rows_.columns(), std::size(kLeafCloud), fmt::join(kLeafCloud, " "));
    names_.assign(std::begin(kLeafCloud), std::end(kLeafCloud));
  }

  /// Names of the columns; "" for row numbers.
  const std::vector<std::string>& names() const { return names_; }
  bool has_names() const { return rows_.has_names(); }
  Location names_where() const { return rows_.names_where(); }
  size_t rows_left() const { return rows_.rows_left(); }
  /// Reads the next row. Returns false at the end. Throws InputError with line and column.
  bool next(std::vector<double>& values) {
    if (!rows_.next()) return false;
    rows_.check_fields();
    values.resize(names_.size());
    for (size_t i = 0; i < values.size(); ++i) {
      if (names_[i].empty()) continue;
      const std::string_view word = rows_.fields()[i].text;
      const auto value = rows_.number(word);
      if (!value || !std::isfinite(*value))
        fail(where(i), "column \"{}\" needs a number, \"{}\" was given; remove columns of words", names_[i], word);
      values[i] = *value;
    }
    return true;
  }
  /// Goes back to the first row.
  void rewind() { rows_ = start_; }
  Location where() const { return rows_.where(); }
  /// Location of a value of the last row.
  Location where(size_t value) const { return rows_.where(value); }

  /// Columns of a file without names: a disk's radius, centre and normal in each line.
  static constexpr const char* kLeafCloud[] = {"radius", "x", "y", "z", "nx", "ny", "nz"};

 private:
  std::string text_;
  TextTable start_, rows_;
  std::vector<std::string> names_;
};

/// Assigns columns to the position, orientation and scale of an instance.
class Placement {
 public:
  /// Throws InputError if the position is missing, or if the orientation is incomplete or given twice.
  explicit Placement(const NumberTable& table) : names_(table.names()) {
    const Location where = table.names_where();
    for (const char* name : {"x", "y", "z"})
      if (!place(name, where))
        fail(where, "there is no column \"{}\"; x, y and z are the position of an instance", name);
    const auto whole = [&](std::initializer_list<const char*> group) {
      const auto given = std::ranges::count_if(group, [&](const char* name) { return place(name, where).has_value(); });
      if (given != 0 && size_t(given) != group.size())
        fail(where, "columns {} must be given together: {} of them are present", fmt::join(group, ", "), given);
      return given != 0;
    };
    by_matrix_ = whole({"m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22"});
    by_quaternion_ = whole({"qw", "qx", "qy", "qz"});
    by_normal_ = whole({"nx", "ny", "nz"});
    by_angles_ = whole({"zenith", "azimuth"});
    if (by_matrix_ + by_quaternion_ + by_normal_ + by_angles_ > 1)
      fail(where, "give the orientation by only one of a matrix, a quaternion, a normal and angles");
    const bool has_scale = place("scale", where).has_value();
    by_radius_ = place("radius", where).has_value();
    if (has_scale && by_radius_)
      fail(where,
           "\"scale\" and \"radius\" both give the size of an instance: keep one, or rename the other, which is "
           "then a number for Texture \"instance\"");
    if (place("spin", where) && (by_matrix_ || by_quaternion_))
      fail(where, "\"spin\" is a rotation about a normal; a matrix or a quaternion includes it");
    for (size_t i = 0; i < names_.size(); ++i)
      if (!names_[i].empty() && !std::ranges::any_of(used_, [i](const auto& u) { return u.second == i; }))
        add_column(i, where);
  }

  /// Throws InputError for a scale below 0: it would turn a leaf into its mirror image, with the sides swapped.
  void check_scale(const NumberTable& table, const std::vector<double>& v) const {
    if (const auto column = used_.find("scale"); column != used_.end() && v[column->second] < 0)
      fail(table.where(column->second), "the scale {:g} is below 0: to turn a leaf over, negate its normal",
           v[column->second]);
    if (const auto column = used_.find("radius"); column != used_.end() && !(v[column->second] > 0))
      fail(table.where(column->second), "the radius {:g} is not above 0", v[column->second]);
  }

  /// Throws InputError for a file without names whose last three columns are no unit vector.
  void check_leaf_cloud(const NumberTable& table, const std::vector<double>& v) const {
    constexpr double kRounding = 0.02;
    const double length = std::sqrt(v[4] * v[4] + v[5] * v[5] + v[6] * v[6]);
    if (std::abs(length - 1) > kRounding)
      fail(table.where(4),
           "the normal has the length {:.4g}: a file without names of columns has {}; name the columns "
           "in the first line",
           length, fmt::join(NumberTable::kLeafCloud, " "));
  }

  /// Whether a column "radius" scales the object.
  bool by_radius() const { return by_radius_; }
  /// Columns that look like a size or an orientation and are none, while the table has no other.
  std::vector<std::string> ambiguous_columns() const {
    constexpr std::string_view kSizes[] = {"size",      "diameter", "length", "width",  "area",  "leafarea",
                                           "leaf_area", "r",        "sx",     "sy",     "sz",    "scale_x",
                                           "scale_y",   "scale_z",  "scalex", "scaley", "scalez"};
    constexpr std::string_view kAngles[] = {"theta",      "phi",         "inclination", "tilt",     "roll",
                                            "pitch",      "yaw",         "rx",          "ry",       "rz",
                                            "zenith_deg", "azimuth_deg", "normal_x",    "normal_y", "normal_z"};
    const bool has_size = by_radius_ || by_matrix_ || used_.contains("scale"),
               has_angle = by_matrix_ || by_quaternion_ || by_normal_ || by_angles_;
    std::vector<std::string> found;
    for (const size_t column : columns_) {
      const std::string name = lower_case(names_[column]);
      if ((!has_size && std::ranges::find(kSizes, name) != std::end(kSizes)) ||
          (!has_angle && std::ranges::find(kAngles, name) != std::end(kAngles)))
        found.push_back(names_[column]);
    }
    return found;
  }

  /// Indices of all other columns.
  const std::vector<size_t>& columns() const { return columns_; }

  /// Returns the object-to-world map of a row. Throws InputError for a normal or a quaternion of length 0.
  PreciseTransform::Rows map(const std::vector<double>& v, const Location& where) const {
    const auto at = [&](const char* name, double otherwise) {
      const auto column = used_.find(name);
      return column == used_.end() ? otherwise : v[column->second];
    };
    const Vec3d position{at("x", 0), at("y", 0), at("z", 0)};
    const double scale = at(by_radius_ ? "radius" : "scale", 1);
    if (by_matrix_) {
      PreciseTransform::Rows rows;
      constexpr const char* kNames[3][3] = {{"m00", "m01", "m02"}, {"m10", "m11", "m12"}, {"m20", "m21", "m22"}};
      for (size_t i = 0; i < 3; ++i)
        rows[i] = {at(kNames[i][0], 0) * scale, at(kNames[i][1], 0) * scale, at(kNames[i][2], 0) * scale,
                   position[int(i)]};
      return rows;
    }
    if (by_quaternion_)
      return quaternion_map(position, {at("qx", 0), at("qy", 0), at("qz", 0)}, at("qw", 1), scale, where);
    Vec3d normal{0, 0, 1};
    if (by_normal_) normal = {at("nx", 0), at("ny", 0), at("nz", 1)};
    if (by_angles_) {
      const double zenith = at("zenith", 0) * kDegree, azimuth = at("azimuth", 0) * kDegree;
      normal = {std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)};
    }
    if (normal == Vec3d{}) fail(where, "the normal is 0 0 0");
    return oriented_rows(position, normalize(normal), at("spin", 0) * kDegree, scale);
  }

 private:
  /// Returns the index of a column, in any case of its name, and marks it as used; nullopt if there is none. Throws
  /// InputError if there are several.
  std::optional<size_t> place(const std::string& name, const Location& where) {
    const auto is = [&](const std::string& other) { return lower_case(other) == name; };
    const auto found = std::ranges::find_if(names_, is);
    if (found == names_.end()) return {};
    if (std::ranges::count_if(names_, is) > 1) fail(where, "there are two columns \"{}\"", name);
    return used_[name] = size_t(found - names_.begin());
  }

  /// Adds a column for textures.
  void add_column(size_t column, const Location& where) {
    for (const size_t other : columns_)
      if (names_[other] == names_[column]) fail(where, "there are two columns \"{}\"", names_[column]);
    columns_.push_back(column);
  }

  /// Rotation by the quaternion (q, w), normalized here, and uniform scaling.
  static PreciseTransform::Rows quaternion_map(const Vec3d& position, Vec3d q, double w, double scale,
                                               const Location& where) {
    const double norm = std::sqrt(dot(q, q) + w * w);
    if (norm == 0) fail(where, "the quaternion is 0 0 0 0");
    q = q / norm, w /= norm;
    const auto rotated = [&](const Vec3d& v) { return v + 2 * cross(q, cross(q, v) + w * v); };
    const Vec3d x = rotated({scale, 0, 0}), y = rotated({0, scale, 0}), z = rotated({0, 0, scale});
    PreciseTransform::Rows rows;
    for (int i = 0; i < 3; ++i) rows[size_t(i)] = {x[i], y[i], z[i], position[i]};
    return rows;
  }

  std::vector<std::string> names_;
  std::map<std::string, size_t, std::less<>> used_;
  std::vector<size_t> columns_;
  bool by_matrix_ = false, by_quaternion_ = false, by_normal_ = false, by_angles_ = false, by_radius_ = false;
};

/// Names what a table leaves to assumptions.
void report_assumptions(const JobRun& run, const NumberTable& table, const Placement& placement) {
  if (!table.has_names())
    run.log().info(fmt::format("{}: no names of columns: they are taken as {}, as Eradiate and RAMI write leaf clouds",
                               run.args.text("csv"), fmt::join(NumberTable::kLeafCloud, " ")));
  if (placement.by_radius()) run.log().info("\"radius\" is the scale: the object that is placed has the radius 1");
  if (const auto unclear = placement.ambiguous_columns(); !unclear.empty())
    run.log().warn(table.names_where(),
                   fmt::format("\"{}\" changes neither size nor orientation; columns for these are scale or radius, "
                               "and nx,ny,nz or zenith,azimuth (degrees): rename or remove it",
                               fmt::join(unclear, "\", \"")));
}

/// Returns the type of the table's maps: they are read once before, because the header comes first.
MapType map_type_of(NumberTable& table, const Placement& placement) {
  double reach = 0;
  for (std::vector<double> values; table.next(values);)
    for (const auto& row : placement.map(values, table.where())) reach = std::max(reach, std::abs(row[3]));
  table.rewind();
  return map_type(reach);
}

/// The job: converts row by row, so that memory does not grow with the number of instances.
Result instances(const JobRun& run) {
  NumberTable table(run.args.text("csv"));
  const Placement placement(table);
  std::vector<std::string> names;
  for (const size_t column : placement.columns()) names.push_back(table.names()[column]);
  const size_t rows = table.rows_left();
  if (rows == 0) fail(table.names_where(), "the file has no rows, only the names of columns");
  report_assumptions(run, table, placement);
  const std::string output = binary_file_of(run.args, "output");
  const MapType type = map_type_of(table, placement);
  InstanceWriter writer(output, rows, names, type);
  std::vector<double> values;
  std::vector<float> numbers(names.size());
  while (table.next(values)) {
    placement.check_scale(table, values);
    if (!table.has_names()) placement.check_leaf_cloud(table, values);
    const PreciseTransform::Rows map = placement.map(values, table.where());
    if (const std::string problem = problem_of(rounded_map(map)); !problem.empty())
      fail(table.where(), "this instance is not possible: {}", problem);
    for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = float(values[placement.columns()[i]]);
    writer.add(map, numbers);
  }
  writer.finish();
  run.log().info(fmt::format(
      "{}: {} instance{}{}{}", run.args.text("output"), rows, rows == 1 ? "" : "s",
      names.empty() ? "" : fmt::format(", with numbers for Texture \"instance\": {}", fmt::join(names, ", ")),
      type == MapType::precise ? ", 64-bit floats for positions far from the origin" : ""));
  return {.facts = {{"instances", double(rows)}}};
}

}  // namespace

extern const JobInfo kInstancesJob(
    "instances", "Scenes", "Write an instance table, for Shape \"instances\", from CSV.",
    "The first line names the columns: position x,y,z; size as scale, or as radius for an object of radius 1; "
    "orientation as nx,ny,nz or zenith,azimuth (degrees) of the z axis, which is a leaf's normal, and spin about it "
    "(degrees), or as qw,qx,qy,qz, or m00,m01 to m22. All other columns are numbers for Texture \"instance\". Without "
    "names: radius x y z nx ny nz. Fields are separated by commas, semicolons, tabs or blanks.",
    kInstancesParams, SessionUse::none, instances);

}  // namespace frond
