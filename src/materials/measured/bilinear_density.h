#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"

namespace frond {

/// Weighted sum of up to four slices of a stack: interpolation between two azimuths and two polar angles.
struct SliceMix {
  std::array<uint32_t, 4> slice{};
  std::array<float, 4> weight{};
  uint32_t count = 0;

  void add(uint32_t s, float w) {
    if (w > 0) slice[count] = s, weight[count] = w, ++count;
  }
};

/// Values on a regular grid over the unit square, in slices [slice][y][x], interpolated bilinearly.
class BilinearStack {
 public:
  /// A cell of the grid, and a position in it.
  struct Cell {
    uint32_t x, y;
    Vec2 t;  ///< in [0, 1]
  };

  BilinearStack() = default;
  /// `width` and `height`: numbers of values, at least 2.
  BilinearStack(std::vector<float> values, size_t width, size_t height);

  /// Cell that contains a point of the unit square.
  Cell cell(Vec2 p) const;
  /// Interpolated value of one slice.
  float value(size_t slice, const Cell& cell) const;
  /// Sum over the slices of a mix.
  float value(const SliceMix& mix, const Cell& cell) const;

 protected:
  /// Sum over the slices of the element (x, y) of an array like the values.
  float sum(const std::vector<float>& array, const SliceMix& mix, uint32_t x, uint32_t y) const;

  std::vector<float> values_;
  uint32_t width_ = 0, height_ = 0;
};

/// Bilinear densities over the unit square, one for each slice, and their interpolations. Samples are drawn by
/// inversion: first y by the marginal density, then x by the conditional one. Interpolation between slices applies to
/// the cumulative functions, so it is exact.
class BilinearDensity : public BilinearStack {
 public:
  struct Mapped {
    Vec2 p;
    float density;  ///< at the point in the space of the density
  };

  BilinearDensity() = default;
  /// Values from 0; each slice is scaled to an integral of 1. A slice of zeros remains.
  BilinearDensity(std::vector<float> values, size_t width, size_t height);

  /// Maps a uniform point of the unit square.
  Mapped sample(const SliceMix& mix, Vec2 u) const;
  /// Inverse of `sample`.
  Mapped invert(const SliceMix& mix, Vec2 p) const;

 private:
  /// Integral of the density over all cells below row y.
  float cumulative(const SliceMix& mix, uint32_t y) const;

  std::vector<float> left_;    ///< [slice][y][x]: integral along the row from its start to the node x, in cells
  std::vector<float> bottom_;  ///< [slice][y]: integral over the rows below
};

}  // namespace frond
