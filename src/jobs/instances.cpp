#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "jobs/record/common_params.h"
#include "scene/format/tokenizer.h"
#include "scene/format/words.h"
#include "scene/geometry/instance_writer.h"
#include "system/file_bytes.h"

namespace frond {

// `frond instances`: instance table from a CSV file.

namespace {

using enum ArgumentKind;

constexpr JobParam kParams[] = {
    JobParam("csv", text, "CSV file to read.",
             {.type = "FILE", .path = PathUse::read, .positional = true, .required = true}),
    output_param("Instance table to write, a NumPy file (.npy).", true),
};

constexpr double kDegree = std::numbers::pi / 180;

/// A CSV file of numbers, read line by line. Its first line names the columns.
class NumberTable {
 public:
  explicit NumberTable(const std::string& path)
      : file_(std::make_shared<const std::string>(path)), text_(read_file_bytes(path, {})), rest_(text_) {
    std::string_view line;
    if (!next_line(line)) fail({file_, 1, 1}, "the file is empty: its first line names the columns");
    for (const std::string& name : split(std::string(trimmed(line)), ',')) names_.emplace_back(trimmed(name));
    for (size_t i = 0; i < names_.size(); ++i)
      if (std::find(names_.begin(), names_.begin() + ptrdiff_t(i), names_[i]) != names_.begin() + ptrdiff_t(i))
        fail({file_, line_, 1}, "there are two columns \"{}\"", names_[i]);
  }

  const std::vector<std::string>& names() const { return names_; }
  /// Number of lines with values.
  size_t count() const {
    size_t lines = 0;
    std::string_view rest = rest_;
    while (!rest.empty()) {
      const size_t end = rest.find('\n');
      lines += !trimmed(rest.substr(0, end)).empty();
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    return lines;
  }
  /// Reads the next line that is not blank. Returns false at the end. Throws InputError with line and column.
  bool next(std::vector<double>& values) {
    std::string_view line;
    do {
      if (!next_line(line)) return false;
    } while (trimmed(line).empty());
    values.clear();
    columns_.clear();
    const char* begin = line.data();
    while (true) {
      const size_t comma = line.find(',');
      const std::string_view word = trimmed(line.substr(0, comma));
      const auto value = parse_number(word);
      columns_.push_back(int(line.data() - begin) + 1);
      if (!value || !std::isfinite(*value)) fail(where(values.size()), "a number is needed, \"{}\" was given", word);
      values.push_back(*value);
      if (comma == std::string_view::npos) break;
      line.remove_prefix(comma + 1);
    }
    if (values.size() != names_.size())
      fail({file_, line_, 1}, "{} values, the first line names {} columns", values.size(), names_.size());
    return true;
  }
  Location where() const { return {file_, line_, 1}; }
  /// Place of a value of the last line.
  Location where(size_t value) const { return {file_, line_, columns_[value]}; }
  const std::shared_ptr<const std::string>& file() const { return file_; }

 private:
  /// Returns the text without blanks at both ends.
  static std::string_view trimmed(std::string_view s) {
    constexpr std::string_view kBlank = " \t\r";
    const size_t first = s.find_first_not_of(kBlank);
    return first == std::string_view::npos ? std::string_view()
                                           : s.substr(first, s.find_last_not_of(kBlank) - first + 1);
  }
  /// Takes the next line, and counts lines for errors. Returns false at the end.
  bool next_line(std::string_view& line) {
    if (rest_.empty()) return false;
    const size_t end = rest_.find('\n');
    line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    return true;
  }

  std::shared_ptr<const std::string> file_;
  std::string text_;
  std::string_view rest_;
  std::vector<std::string> names_;
  std::vector<int> columns_;  ///< where the values of the last line begin
  int line_ = 0;
};

/// Assigns columns to the position, orientation and scale of an instance.
class Placement {
 public:
  /// Throws InputError if the position is missing, or if the orientation is incomplete or given twice.
  explicit Placement(const NumberTable& table) : names_(table.names()) {
    const Location where{table.file(), 1, 1};
    for (const char* name : {"x", "y", "z"})
      if (!place(name)) fail(where, "there is no column \"{}\"; x, y and z are the position of an instance", name);
    const auto whole = [&](std::initializer_list<const char*> group) {
      const auto given = std::ranges::count_if(group, [&](const char* name) { return place(name).has_value(); });
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
    place("scale");
    if (place("spin") && (by_matrix_ || by_quaternion_))
      fail(where, "\"spin\" is a rotation about a normal; a matrix or a quaternion includes it");
    for (size_t i = 0; i < names_.size(); ++i)
      if (!used_.contains(names_[i])) columns_.push_back(i);
  }

  /// Throws InputError for a scale below 0: it would turn a leaf into its mirror image, with the sides swapped.
  void check_scale(const NumberTable& table, const std::vector<double>& v) const {
    const auto column = used_.find("scale");
    if (column != used_.end() && v[column->second] < 0)
      fail(table.where(column->second), "the scale {:g} is below 0: to turn a leaf over, negate its normal",
           v[column->second]);
  }

  /// Indices of all other columns.
  const std::vector<size_t>& columns() const { return columns_; }

  /// Returns the object-to-world map of a row. Throws InputError for a normal or a quaternion of length 0.
  AffineMap map(const std::vector<double>& v, const Location& where) const {
    const auto at = [&](const char* name, double otherwise) {
      const auto column = used_.find(name);
      return column == used_.end() ? otherwise : v[column->second];
    };
    const Vec3d position{at("x", 0), at("y", 0), at("z", 0)};
    const double scale = at("scale", 1);
    if (by_matrix_) {
      AffineMap map;
      constexpr const char* kNames[3][3] = {{"m00", "m01", "m02"}, {"m10", "m11", "m12"}, {"m20", "m21", "m22"}};
      for (size_t i = 0; i < 3; ++i)
        map.rows[i] = {float(at(kNames[i][0], 0) * scale), float(at(kNames[i][1], 0) * scale),
                       float(at(kNames[i][2], 0) * scale), float(position[int(i)])};
      return map;
    }
    if (by_quaternion_) return turned(position, {at("qx", 0), at("qy", 0), at("qz", 0)}, at("qw", 1), scale, where);
    Vec3d normal{0, 0, 1};
    if (by_normal_) normal = {at("nx", 0), at("ny", 0), at("nz", 1)};
    if (by_angles_) {
      const double zenith = at("zenith", 0) * kDegree, azimuth = at("azimuth", 0) * kDegree;
      normal = {std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)};
    }
    if (normal == Vec3d{}) fail(where, "the normal is 0 0 0");
    return oriented_map(position, normalize(normal), at("spin", 0) * kDegree, scale);
  }

 private:
  /// Returns the index of a column and marks it as used; nullopt if there is none.
  std::optional<size_t> place(const std::string& name) {
    const auto found = std::ranges::find(names_, name);
    if (found == names_.end()) return {};
    return used_[name] = size_t(found - names_.begin());
  }

  /// Rotation by the quaternion (q, w), normalized here, and uniform scaling.
  static AffineMap turned(const Vec3d& position, Vec3d q, double w, double scale, const Location& where) {
    const double norm = std::sqrt(dot(q, q) + w * w);
    if (norm == 0) fail(where, "the quaternion is 0 0 0 0");
    q = q / norm, w /= norm;
    const auto rotated = [&](const Vec3d& v) { return v + 2 * cross(q, cross(q, v) + w * v); };
    const Vec3d x = rotated({scale, 0, 0}), y = rotated({0, scale, 0}), z = rotated({0, 0, scale});
    AffineMap map;
    for (int i = 0; i < 3; ++i) map.rows[size_t(i)] = {float(x[i]), float(y[i]), float(z[i]), float(position[i])};
    return map;
  }

  std::vector<std::string> names_;
  std::map<std::string, size_t, std::less<>> used_;
  std::vector<size_t> columns_;
  bool by_matrix_ = false, by_quaternion_ = false, by_normal_ = false, by_angles_ = false;
};

/// The job: converts row by row, so that memory does not grow with the number of instances.
Result instances(const JobRun& run) {
  NumberTable table(run.args.text("csv"));
  const Placement placement(table);
  std::vector<std::string> names;
  for (const size_t column : placement.columns()) names.push_back(table.names()[column]);
  const size_t rows = table.count();
  if (rows == 0) fail({table.file(), 1, 1}, "the file has no rows, only the names of columns");
  InstanceWriter writer(binary_file_of(run.args, "output"), rows, names);
  std::vector<double> values;
  std::vector<float> numbers(names.size());
  while (table.next(values)) {
    placement.check_scale(table, values);
    const AffineMap map = placement.map(values, table.where());
    if (const std::string problem = problem_of(map); !problem.empty())
      fail(table.where(), "this instance is not possible: {}", problem);
    for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = float(values[placement.columns()[i]]);
    writer.add(map, numbers);
  }
  writer.finish();
  run.log().info(fmt::format("{}: {} instance{}{}", run.args.text("output"), rows, rows == 1 ? "" : "s",
                             names.empty() ? "" : fmt::format(", with {}", fmt::join(names, ", "))));
  return {.facts = {{"instances", double(rows)}}};
}

}  // namespace

extern const JobInfo kInstancesJob(
    "instances", "Scenes", "Write an instance table, for Shape \"instances\", from CSV.",
    "The first line names the columns: position x,y,z; scale; orientation as nx,ny,nz or zenith,azimuth (degrees) "
    "of the z axis, which is a leaf's normal, and spin about it (degrees), or as qw,qx,qy,qz, or m00,m01 to "
    "m22. All other columns are numbers for Texture \"instance\".",
    kParams, SessionUse::none, instances);

}  // namespace frond
