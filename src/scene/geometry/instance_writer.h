#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/math/affine_map.h"
#include "core/math/precise_transform.h"
#include "system/atomic_file.h"

namespace frond {

/// Type of the numbers of an instance table's maps.
enum class MapType : uint8_t { single, precise };

/// Returns the type that keeps positions up to `largest` from the origin: 32-bit floats where their steps are below
/// half a thousandth (up to 4,096), else 64-bit ones.
constexpr MapType map_type(double largest) { return largest < 4096 ? MapType::single : MapType::precise; }

/// Writes an InstanceTable's file row by row.
class InstanceWriter {
 public:
  /// Throws InputError if the file cannot be written, or if a name is not allowed in a NumPy header.
  InstanceWriter(const std::filesystem::path& path, size_t rows, const std::vector<std::string>& columns,
                 MapType type = MapType::single);
  /// Appends a row with one value for each column.
  void add(const PreciseTransform::Rows& map, std::span<const float> values);
  void add(const AffineMap& map, std::span<const float> values);
  /// Completes the file. Call after the last row.
  void finish();

 private:
  void flush();

  NewFile file_;
  size_t columns_, rows_left_;
  MapType type_;
  std::vector<unsigned char> buffer_;
};

/// Returns a map from the direction of its z axis, a rotation about it (radians), and a scale. The front of a leaf
/// faces +z.
PreciseTransform::Rows oriented_rows(const Vec3d& position, const Vec3d& normal, double spin, double scale);

}  // namespace frond
