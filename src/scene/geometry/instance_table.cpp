#include "scene/geometry/instance_table.h"

#include <algorithm>
#include <mutex>

#include "core/excerpt.h"
#include "scene/geometry/npy.h"
#include "system/file_bytes.h"

namespace frond {
namespace {

constexpr std::string_view kNumber = "<f4";
constexpr size_t kMapNumbers = 12;

/// The map is the field "transform", or the rows of a plain array.
bool is_map(const NpyField& field) {
  return field.count() == kMapNumbers && (field.name.empty() || field.name == "transform");
}

}  // namespace

InstanceTable::InstanceTable(std::shared_ptr<const std::vector<AffineMap>> maps)
    : own_(std::move(maps)),
      first_(reinterpret_cast<const std::byte*>(own_->data())),
      size_(own_->size()),
      stride_(sizeof(AffineMap)) {
  for (const AffineMap& map : *own_) inverse_stretch_ = std::max(inverse_stretch_, map.inverse().largest_stretch());
}

InstanceTable::InstanceTable(const std::filesystem::path& path, const Location& where, const ThreadPool& pool)
    : file_(read_file_bytes(path, where)) {
  const auto bytes_of_file = std::as_bytes(std::span(file_));
  const NpyLayout layout = read_npy_layout(bytes_of_file, path.string(), where);
  bool found = false;
  for (const NpyField& field : layout.fields) {
    if (field.name.empty() && field.type.find('V') != std::string::npos) continue;  // padding of a record
    if (field.type != kNumber)
      fail(where, "{}: \"{}\" holds {}: numbers are {} (numpy.float32)", path.string(),
           field.name.empty() ? "the array" : excerpt(field.name, path), excerpt(field.type, path), kNumber);
    if (is_map(field))
      found = true, map_offset_ = field.offset;
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
  check(path, where, pool);
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

}  // namespace frond
