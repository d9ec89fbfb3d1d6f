#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "core/error.h"
#include "core/shape.h"

namespace frond {

/// Grid of floats of a NanoVDB file, in memory: values at integer indices, with an affine map to the file's own space.
class NanoVdbGrid {
 public:
  /// Reads the grid called `name` from the bytes of a file, and checks all of its nodes, so that no lookup leaves its
  /// memory. Returns nullptr if the file has no grid of this name. Throws InputError at `where` for a file that is
  /// damaged, truncated or compressed by BLOSC, and for grids other than fog volumes of 32-bit floats.
  static std::unique_ptr<NanoVdbGrid> read(std::string_view all, const std::string& name_of_file, std::string_view name,
                                           const Location& where);
  virtual ~NanoVdbGrid() = default;

  /// Value at a point of the file's space, interpolated linearly between indices.
  virtual float at(const Vec3& p) const = 0;
  /// Box of the values in the file's space: from the first index to one past the last.
  virtual Bounds bounds() const = 0;
  /// Calls `use(low, high, value)` for boxes of the file's space outside of which a value above 0 has no effect.
  virtual void for_each(const std::function<void(const Vec3&, const Vec3&, float)>& use) const = 0;
};

}  // namespace frond
