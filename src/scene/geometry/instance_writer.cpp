#include "scene/geometry/instance_writer.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "scene/geometry/npy.h"

namespace frond {

namespace {

template <class T>
void append(std::vector<unsigned char>& bytes, T number) {
  // The limit is that of a 32-bit float in either type, because maps are used in 32 bits.
  if (!std::isfinite(float(number)))
    fail({}, "an instance has numbers beyond {:.2g}, the largest of a table", std::numeric_limits<float>::max());
  const auto* first = reinterpret_cast<const unsigned char*>(&number);
  bytes.insert(bytes.end(), first, first + sizeof number);
}

}  // namespace

InstanceWriter::InstanceWriter(const std::filesystem::path& path, size_t rows, const std::vector<std::string>& columns,
                               MapType type)
    : file_(path), columns_(columns.size()), rows_left_(rows), type_(type) {
  std::vector<NpyField> fields{{.name = "transform", .type = type == MapType::single ? "<f4" : "<f8", .shape = {3, 4}}};
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
void InstanceWriter::add(const PreciseTransform::Rows& map, std::span<const float> values) {
  constexpr size_t kBuffer = 1 << 20;
  assert(values.size() == columns_ && rows_left_ > 0);
  for (const auto& row : map)
    for (const double v : row) type_ == MapType::single ? append(buffer_, float(v)) : append(buffer_, v);
  for (const float v : values) append(buffer_, v);
  --rows_left_;
  if (buffer_.size() >= kBuffer) flush();
}

void InstanceWriter::add(const AffineMap& map, std::span<const float> values) { add(precise_rows(map), values); }

void InstanceWriter::flush() {
  file_.write({buffer_.data(), buffer_.size()});
  buffer_.clear();
}

/// All rows announced to the constructor must have been added.
void InstanceWriter::finish() {
  assert(rows_left_ == 0);
  flush();
  file_.finish();
}

PreciseTransform::Rows oriented_rows(const Vec3d& position, const Vec3d& normal, double spin, double scale) {
  const Framed frame = Framed::around(normal);
  const Vec3d x = (frame.x * std::cos(spin) + frame.y * std::sin(spin)) * scale;
  const Vec3d y = (frame.y * std::cos(spin) - frame.x * std::sin(spin)) * scale, z = normal * scale;
  PreciseTransform::Rows rows;
  for (int i = 0; i < 3; ++i) rows[size_t(i)] = {x[i], y[i], z[i], position[i]};
  return rows;
}

}  // namespace frond
