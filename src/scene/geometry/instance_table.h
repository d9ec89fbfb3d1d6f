#pragma once

#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "core/math/affine_map.h"
#include "core/math/precise_transform.h"
#include "core/parallel.h"
#include "core/texture.h"

namespace frond {

/// Origins of a table: points of its space and of the object's space to which rows are relative, because coordinates
/// would otherwise be large.
struct TableOrigins {
  Vec3d table{};   ///< applied to tables whose rows lie far from the origin
  Vec3d object{};  ///< subtracted from the coordinates of the object that the table places
  friend auto operator<=>(const TableOrigins& a, const TableOrigins& b) {
    return std::tie(a.table.x, a.table.y, a.table.z, a.object.x, a.object.y, a.object.z) <=>
           std::tie(b.table.x, b.table.y, b.table.z, b.object.x, b.object.y, b.object.z);
  }
};

/// Origins of a table under a transform, with an object's.
inline TableOrigins origins_of(const PreciseTransform& world_from_table, const Vec3d& object) {
  const Vec3d near = world_from_table.inverse_point({});
  return {is_far(near) ? near : Vec3d{}, object};
}

/// Table of instances: an affine map for each row, and numbers for Texture "instance". Rows are the
/// content of a file, or shared with a scene.
class InstanceTable {
 public:
  explicit InstanceTable(std::shared_ptr<const std::vector<AffineMap>> maps);
  /// Reads a NumPy file: an array of shape (rows, 12) or (rows, 3, 4), or records with a field "transform" of 12
  /// numbers and any number of scalar fields; all "<f4", but "transform" may be "<f8". Throws InputError at `where`,
  /// also for maps without an inverse.
  InstanceTable(const std::filesystem::path& path, const Location& where, const ThreadPool& pool,
                const TableOrigins& origins = {});

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
  /// The point of the table's space that the maps are relative to: 0, or TableOrigins::table.
  const Vec3d& origin() const { return origin_; }
  /// Distance of neighbouring 32-bit floats in a file that has such, far from the origin; else 0.
  double step() const { return step_; }

 private:
  /// Rewrites the rows of a file in place: 32-bit floats, relative to the origins, and the columns.
  void convert(bool is_double, const Vec3d& object);
  /// Throws InputError for an invalid map, and computes the ranges of the columns and the stretch.
  void check(const std::filesystem::path& path, const Location& where, const ThreadPool& pool);

  std::shared_ptr<const std::vector<AffineMap>> own_;
  std::string file_;
  const std::byte* first_ = nullptr;
  size_t size_ = 0, stride_ = 0, map_offset_ = 0;
  float inverse_stretch_ = 0;
  std::vector<InstanceColumn> columns_;
  Vec3d origin_{};
  double step_ = 0;
};

/// Some maps of a table's file, to know where it lies before it is read.
struct InstanceTableSample {
  std::vector<PreciseTransform::Rows> maps;
  size_t rows;  ///< number of all
};

/// Returns nullopt for a file that is no table.
std::optional<InstanceTableSample> sample_instance_table(const std::filesystem::path& path);

}  // namespace frond
