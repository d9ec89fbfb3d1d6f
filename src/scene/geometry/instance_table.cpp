#include "scene/geometry/instance_table.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <span>

#include "core/messages/excerpt.h"
#include "scene/geometry/npy.h"
#include "system/file_bytes.h"
#include "system/file_range.h"

namespace frond {
namespace {

constexpr std::string_view kNumber = "<f4", kDouble = "<f8";
constexpr size_t kMapNumbers = 12;

/// The map is the field "transform", or the rows of a plain array.
bool is_map(const NpyField& field) {
  return field.count() == kMapNumbers && (field.name.empty() || field.name == "transform");
}

/// The map at the beginning of some bytes, in 32-bit or 64-bit floats.
PreciseTransform::Rows map_at(const std::byte* bytes, bool is_double) {
  if (is_double) {
    PreciseTransform::Rows rows;
    std::memcpy(rows.data(), bytes, sizeof rows);
    return rows;
  }
  AffineMap map;
  std::memcpy(map.rows.data(), bytes, sizeof map.rows);
  return precise_rows(map);
}

Vec3d translation(const PreciseTransform::Rows& m) { return {m[0][3], m[1][3], m[2][3]}; }

}  // namespace

InstanceTable::InstanceTable(std::shared_ptr<const std::vector<AffineMap>> maps)
    : own_(std::move(maps)),
      first_(reinterpret_cast<const std::byte*>(own_->data())),
      size_(own_->size()),
      stride_(sizeof(AffineMap)) {
  for (const AffineMap& map : *own_) inverse_stretch_ = std::max(inverse_stretch_, map.inverse().largest_stretch());
}

InstanceTable::InstanceTable(const std::filesystem::path& path, const Location& where, const ThreadPool& pool,
                             const TableOrigins& origins)
    : file_(read_file_bytes(path, where)) {
  const auto bytes_of_file = std::as_bytes(std::span(file_));
  const NpyLayout layout = read_npy_layout(bytes_of_file, path.string(), where);
  bool found = false, is_double = false;
  for (const NpyField& field : layout.fields) {
    if (field.name.empty() && field.type.find('V') != std::string::npos) continue;  // padding of a record
    if (field.type != kNumber && !(is_map(field) && field.type == kDouble))
      fail(where, "{}: \"{}\" holds {}: numbers are {} (numpy.float32), those of \"transform\" may be {}",
           path.string(), field.name.empty() ? "the array" : excerpt(field.name, path), excerpt(field.type, path),
           kNumber, kDouble);
    if (is_map(field))
      found = true, map_offset_ = field.offset, is_double = field.type == kDouble;
    else if (field.count() == 1 && !field.name.empty())
      columns_.push_back({field.name, field.offset, {INFINITY, -INFINITY}});
    else
      fail(where, "{}: \"{}\" has {} numbers in a row: \"transform\" has {}, all others have one", path.string(),
           excerpt(field.name, path), field.count(), kMapNumbers);
  }
  if (!found)
    fail(where, "{}: no field \"transform\" of {} numbers: the three rows of a matrix, four numbers each",
         path.string(), kMapNumbers);
  constexpr size_t kMost = 0xfffffffe;  // limit of one geometry in Embree
  if (layout.rows > kMost)
    fail(where, "{}: {} rows, {} is the limit: tables of tables hold more", path.string(), layout.rows, kMost);
  first_ = bytes_of_file.data() + layout.begin;
  size_ = layout.rows;
  stride_ = layout.row_bytes;
  for (const size_t row : {size_t{0}, size_ / 2, size_ - 1}) {
    if (row >= size_) continue;
    const double reach = largest_coordinate(translation(map_at(bytes(row) + map_offset_, is_double)));
    if (!(reach > kFar && std::isfinite(reach))) continue;
    origin_ = origins.table;
    if (!is_double) step_ = std::max(step_, float_spacing(reach));
  }
  if (is_double || origin_ != Vec3d{} || origins.object != Vec3d{}) convert(is_double, origins.object);
  check(path, where, pool);
}

/// A row does not become longer.
void InstanceTable::convert(bool is_double, const Vec3d& object) {
  constexpr size_t kBlock = 1 << 16;
  const size_t begin = size_t(first_ - reinterpret_cast<const std::byte*>(file_.data()));
  std::byte* const to = reinterpret_cast<std::byte*>(file_.data()) + begin;
  const size_t stride = sizeof(AffineMap) + columns_.size() * sizeof(float);
  std::vector<float> values(columns_.size());
  for (size_t row = 0; row < size_; ++row) {
    if (row % kBlock == 0) check_stop();
    const std::byte* const from = bytes(row);
    const PreciseTransform::Rows m = map_at(from + map_offset_, is_double);
    for (size_t c = 0; c < values.size(); ++c) std::memcpy(&values[c], from + columns_[c].offset, sizeof(float));
    AffineMap map;
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = 0; j < 3; ++j) map.rows[i][j] = float(m[i][j]);
      map.rows[i][3] =
          float(m[i][0] * object.x + m[i][1] * object.y + m[i][2] * object.z + (m[i][3] - origin_[int(i)]));
    }
    std::memcpy(to + row * stride, map.rows.data(), sizeof map.rows);
    if (!values.empty()) std::memcpy(to + row * stride + sizeof map.rows, values.data(), values.size() * sizeof(float));
  }
  file_.resize(begin + size_ * stride);
  if (is_double) file_.shrink_to_fit();
  first_ = reinterpret_cast<const std::byte*>(file_.data()) + begin;
  stride_ = stride;
  map_offset_ = 0;
  for (size_t c = 0; c < columns_.size(); ++c) columns_[c].offset = sizeof(AffineMap) + c * sizeof(float);
}

/// Checks blocks of rows in parallel; the error names the first invalid row.
void InstanceTable::check(const std::filesystem::path& path, const Location& where, const ThreadPool& pool) {
  constexpr size_t kBlock = 1 << 16;
  std::mutex mutex;
  size_t first_wrong = size_;
  pool.for_each(int64_t((size_ + kBlock - 1) / kBlock), [&](int64_t block, int) {
    std::vector<Interval> ranges(columns_.size(), {INFINITY, -INFINITY});
    size_t wrong = size_;
    float stretch = 0;
    const size_t begin = size_t(block) * kBlock, end = std::min(size_, begin + kBlock);
    for (size_t row = begin; row < end && wrong == size_; ++row) {
      const AffineMap placed = map(row);
      if (!problem_of(placed).empty()) wrong = row;
      stretch = std::max(stretch, placed.inverse().largest_stretch());
      for (size_t c = 0; c < columns_.size(); ++c) {
        float value;
        std::memcpy(&value, bytes(row) + columns_[c].offset, sizeof value);
        if (!std::isfinite(value)) wrong = row;
        ranges[c] = {std::min(ranges[c].min, double(value)), std::max(ranges[c].max, double(value))};
      }
    }
    const std::lock_guard lock(mutex);
    first_wrong = std::min(first_wrong, wrong);
    inverse_stretch_ = std::max(inverse_stretch_, stretch);
    for (size_t c = 0; c < columns_.size(); ++c)
      columns_[c].range = {std::min(columns_[c].range.min, ranges[c].min),
                           std::max(columns_[c].range.max, ranges[c].max)};
  });
  if (first_wrong == size_) return;
  const std::string problem = problem_of(map(first_wrong));
  fail(where, "{}: row {} (counted from 0): {}", path.string(), first_wrong,
       problem.empty() ? "one of its numbers is not finite" : problem);
}

std::optional<InstanceTableSample> sample_instance_table(const std::filesystem::path& path) {
  constexpr size_t kStart = 1 << 14, kMostMaps = 64;
  std::error_code error;
  const std::string start = read_file_range(path, 0, kStart);
  const uint64_t size = std::filesystem::file_size(path, error);
  if (start.empty() || error) return {};
  try {
    const NpyLayout layout = read_npy_layout(std::as_bytes(std::span(start)), path.string(), {}, size);
    InstanceTableSample sample{.maps = {}, .rows = layout.rows};
    for (const NpyField& field : layout.fields) {
      if (!is_map(field) || (field.type != kNumber && field.type != kDouble)) continue;
      const size_t count = std::min(layout.rows, kMostMaps);
      for (size_t i = 0; i < count; ++i) {
        const uint64_t row = uint64_t(i) * layout.rows / count;
        const std::string bytes =
            read_file_range(path, layout.begin + row * layout.row_bytes + field.offset, field.bytes());
        if (bytes.size() == field.bytes())
          sample.maps.push_back(map_at(reinterpret_cast<const std::byte*>(bytes.data()), field.type == kDouble));
      }
      return sample;
    }
  } catch (const InputError&) {  // the table's reader reports it
  }
  return {};
}

}  // namespace frond
