#include "scene/geometry/instance_writer.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "scene/geometry/npy.h"

namespace frond {

InstanceWriter::InstanceWriter(const std::filesystem::path& path, size_t rows, const std::vector<std::string>& columns)
    : file_(path), columns_(columns.size()), rows_left_(rows) {
  std::vector<NpyField> fields{{.name = "transform", .type = "<f4", .shape = {3, 4}}};
  for (const std::string& name : columns) {
    const bool is_name = !name.empty() && name != "transform" && std::ranges::all_of(name, [](unsigned char c) {
      return std::isalnum(c) || c == '_' || c == '-' || c == '.';
    });
    if (!is_name) fail({}, "\"{}\" is not a column name: use letters, digits, _ - and .", name);
    if (std::ranges::count(columns, name) > 1) fail({}, "there are two columns \"{}\"", name);
    fields.push_back({.name = name, .type = "<f4", .shape = {}});
  }
  const std::string header = npy_header(fields, rows);
  constexpr size_t kMost = 10000;  // numpy.load reads no larger header by default
  if (header.size() > kMost)
    fail({}, "the names of {} columns take {} bytes: {} is the limit", columns.size(), header.size(), kMost);
  file_.write({reinterpret_cast<const unsigned char*>(header.data()), header.size()});
}

/// Rows are buffered, so that memory does not grow with their number.
void InstanceWriter::add(const AffineMap& map, std::span<const float> values) {
  constexpr size_t kBuffer = 1 << 18;
  assert(values.size() == columns_ && rows_left_ > 0);
  const size_t begin = buffer_.size();
  for (const auto& row : map.rows) buffer_.insert(buffer_.end(), row.begin(), row.end());
  buffer_.insert(buffer_.end(), values.begin(), values.end());
  if (!std::all_of(buffer_.begin() + std::ptrdiff_t(begin), buffer_.end(), [](float v) { return std::isfinite(v); }))
    fail({}, "an instance has numbers beyond {:.2g}, the largest of a table", std::numeric_limits<float>::max());
  --rows_left_;
  if (buffer_.size() >= kBuffer) flush();
}

void InstanceWriter::flush() {
  file_.write({reinterpret_cast<const unsigned char*>(buffer_.data()), buffer_.size() * sizeof(float)});
  buffer_.clear();
}

/// All rows announced to the constructor must have been added.
void InstanceWriter::finish() {
  assert(rows_left_ == 0);
  flush();
  file_.finish();
}

AffineMap oriented_map(const Vec3d& position, const Vec3d& normal, double spin, double scale) {
  const Framed frame = Framed::around(normal);
  const Vec3d x = (frame.x * std::cos(spin) + frame.y * std::sin(spin)) * scale;
  const Vec3d y = (frame.y * std::cos(spin) - frame.x * std::sin(spin)) * scale, z = normal * scale;
  AffineMap map;
  for (int i = 0; i < 3; ++i) map.rows[size_t(i)] = {float(x[i]), float(y[i]), float(z[i]), float(position[i])};
  return map;
}

}  // namespace frond
