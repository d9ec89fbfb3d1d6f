#pragma once

#include <cstring>
#include <memory>
#include <vector>

#include "core/parallel.h"
#include "core/texture.h"
#include "scene/math/affine_map.h"
#include "system/file_bytes.h"

namespace frond {

/// Instances of objects, a row for each: an affine map, and numbers that textures may ask for. Rows are those of a
/// file, mapped into memory, or the table's own.
class InstanceTable {
 public:
  explicit InstanceTable(std::shared_ptr<const std::vector<AffineMap>> maps);
  /// Of a NumPy file: an array of shape (rows, 12) or (rows, 3, 4), or records with a field "transform" of 12 numbers
  /// and any other single ones; all of them "<f4". Throws InputError at `where`, for maps that cannot be inverted too.
  InstanceTable(const std::filesystem::path& path, const Location& where, const ThreadPool& pool);

  size_t size() const { return size_; }
  AffineMap map(size_t row) const {
    AffineMap map;
    std::memcpy(map.rows.data(), bytes(row) + map_offset_, sizeof map.rows);
    return map;
  }
  const std::vector<InstanceColumn>& columns() const { return columns_; }
  const std::byte* bytes(size_t row) const { return first_ + row * stride_; }

 private:
  /// Says where a map is wrong, and finds the bounds of the columns.
  void check(const std::filesystem::path& path, const Location& where, const ThreadPool& pool);

  std::shared_ptr<const std::vector<AffineMap>> own_;
  std::unique_ptr<MappedFile> file_;
  const std::byte* first_ = nullptr;
  size_t size_ = 0, stride_ = 0, map_offset_ = 0;
  std::vector<InstanceColumn> columns_;
};

}  // namespace frond
