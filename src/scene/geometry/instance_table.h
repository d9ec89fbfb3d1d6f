#pragma once

#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/texture.h"
#include "scene/math/affine_map.h"

namespace frond {

/// Table of instances: an affine map for each row, and numbers for Texture "instance". Rows are the
/// content of a file, or shared with a scene.
class InstanceTable {
 public:
  explicit InstanceTable(std::shared_ptr<const std::vector<AffineMap>> maps);
  /// Reads a NumPy file: an array of shape (rows, 12) or (rows, 3, 4), or records with a field "transform" of 12
  /// numbers and any number of scalar fields; all "<f4". Throws InputError at `where`, also for maps without an
  /// inverse.
  InstanceTable(const std::filesystem::path& path, const Location& where, const ThreadPool& pool);

  InstanceTable(const InstanceTable&) = delete;
  InstanceTable& operator=(const InstanceTable&) = delete;

  size_t size() const { return size_; }
  /// Returns the map of a row. It is copied, because rows of a file may not be aligned.
  AffineMap map(size_t row) const {
    AffineMap map;
    std::memcpy(map.rows.data(), bytes(row) + map_offset_, sizeof map.rows);
    return map;
  }
  const std::vector<InstanceColumn>& columns() const { return columns_; }
  /// Returns the largest AffineMap::Inverse::largest_stretch of all maps.
  float inverse_stretch() const { return inverse_stretch_; }
  const std::byte* bytes(size_t row) const { return first_ + row * stride_; }

 private:
  /// Throws InputError for an invalid map, and computes the ranges of the columns and the stretch.
  void check(const std::filesystem::path& path, const Location& where, const ThreadPool& pool);

  std::shared_ptr<const std::vector<AffineMap>> own_;
  std::string file_;
  const std::byte* first_ = nullptr;
  size_t size_ = 0, stride_ = 0, map_offset_ = 0;
  float inverse_stretch_ = 0;
  std::vector<InstanceColumn> columns_;
};

}  // namespace frond
