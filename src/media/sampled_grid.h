#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "core/majorants.h"
#include "core/math/vec.h"
#include "core/stop.h"

namespace frond {

/// Values at the centres of the cells that divide a box evenly, x fastest, then y, then z. Between them they are
/// interpolated linearly; beyond the outermost centres they fall to 0, as in pbrt-v4.
template <class T>
class SampledGrid {
 public:
  /// `values` has n[0] n[1] n[2] elements.
  SampledGrid(std::vector<T> values, const std::array<int, 3>& n) : values_(std::move(values)), n_(n) {}

  /// Interpolates `convert(value)` at a position in the box, whose coordinates are 0 to 1 within.
  template <class Convert>
  auto at(const Vec3& unit, const Convert& convert) const {
    const Vec3 p{unit.x * float(n_[0]) - 0.5f, unit.y * float(n_[1]) - 0.5f, unit.z * float(n_[2]) - 0.5f};
    const Vec3 corner{std::floor(p.x), std::floor(p.y), std::floor(p.z)}, t = p - corner;
    decltype(convert(values_[0]) * 1.f) sum{};
    for (int k = 0; k < 8; ++k) {
      const float wx = k & 1 ? t.x : 1 - t.x, wy = k & 2 ? t.y : 1 - t.y, wz = k & 4 ? t.z : 1 - t.z;
      const float x = corner.x + float(k & 1), y = corner.y + float(k >> 1 & 1), z = corner.z + float(k >> 2);
      const bool is_inside = x >= 0 && x < float(n_[0]) && y >= 0 && y < float(n_[1]) && z >= 0 && z < float(n_[2]);
      if (is_inside) sum += convert(values_[index(size_t(x), size_t(y), size_t(z))]) * (wx * wy * wz);
    }
    return sum;
  }
  /// The same for a grid of numbers.
  float at(const Vec3& unit) const {
    return at(unit, [](float v) { return v; });
  }

  /// Raises the majorants of the cells in which the value `density(value)` has an effect.
  template <class Density>
  void fill_majorants(MajorantGrid& majorants, const Density& density) const {
    StopPoll poll;
    for (int z = 0; z < n_[2]; ++z)
      for (int y = 0; y < n_[1]; ++y)
        for (int x = 0; x < n_[0]; ++x) {
          poll();
          const auto share = [&](float dx) {
            return Vec3{(float(x) + dx) / float(n_[0]), (float(y) + dx) / float(n_[1]), (float(z) + dx) / float(n_[2])};
          };
          // From the centre of the previous cell to the centre of the next cell, with a margin for rounding.
          majorants.raise_bound(share(-0.5001f), share(1.5001f),
                                density(values_[index(size_t(x), size_t(y), size_t(z))]));
        }
  }

 private:
  /// In size_t: the product of three ints may exceed 2^31.
  size_t index(size_t x, size_t y, size_t z) const { return x + size_t(n_[0]) * (y + size_t(n_[1]) * z); }

  std::vector<T> values_;
  std::array<int, 3> n_;
};

}  // namespace frond
