#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/math/affine_map.h"
#include "system/atomic_file.h"

namespace frond {

/// Writes an InstanceTable's file row by row.
class InstanceWriter {
 public:
  /// Throws InputError if the file cannot be written, or if a name is not allowed in a NumPy header.
  InstanceWriter(const std::filesystem::path& path, size_t rows, const std::vector<std::string>& columns);
  /// Appends a row with one value for each column.
  void add(const AffineMap& map, std::span<const float> values);
  /// Completes the file. Call after the last row.
  void finish();

 private:
  void flush();

  NewFile file_;
  size_t columns_, rows_left_;
  std::vector<float> buffer_;
};

/// Returns a map from the direction of its z axis, a rotation about it (radians), and a scale. The front of a leaf
/// faces +z.
AffineMap oriented_map(const Vec3d& position, const Vec3d& normal, double spin, double scale);

}  // namespace frond
