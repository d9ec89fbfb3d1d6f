#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/math/affine_map.h"
#include "system/atomic_file.h"

namespace frond {

/// Writes a file that an InstanceTable reads, row by row.
class InstanceWriter {
 public:
  /// Throws InputError where the file cannot be written, or a name is none that a NumPy header can have.
  InstanceWriter(const std::filesystem::path& path, size_t rows, const std::vector<std::string>& columns);
  /// As many values as there are columns.
  void add(const AffineMap& map, std::span<const float> values);
  /// After the last row.
  void finish();

 private:
  void flush();

  NewFile file_;
  size_t columns_, rows_left_;
  std::vector<float> buffer_;
};

/// A map from the orientation of its third axis, a turn about it (radians), and a scale: a leaf's, whose front faces
/// +z.
AffineMap oriented_map(const Vec3d& position, const Vec3d& normal, double spin, double scale);

}  // namespace frond
