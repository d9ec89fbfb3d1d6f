#pragma once

#include <array>
#include <vector>

#include "core/math/ray.h"
#include "core/math/transform.h"
#include "core/shape.h"
#include "core/spectrum.h"

namespace frond {

/// Upper bounds of a density over the cells of a cube of cells, which divides a box evenly.
class MajorantGrid {
 public:
  explicit MajorantGrid(int cells_per_axis) : n_(cells_per_axis), cells_(size_t(n_) * size_t(n_) * size_t(n_), 0.f) {}

  int cells_per_axis() const { return n_; }
  float at(const std::array<int, 3>& cell) const { return cells_[index(cell)]; }
  /// Raises the bound of the cells that the box from `low` to `high` overlaps; coordinates are shares of the grid's
  /// box.
  void raise_bound(const Vec3& low, const Vec3& high, float density);

 private:
  size_t index(const std::array<int, 3>& c) const {
    return size_t(c[0]) + size_t(n_) * (size_t(c[1]) + size_t(n_) * size_t(c[2]));
  }

  int n_;
  std::vector<float> cells_;
};

/// Pieces of a ray in a medium, each with a constant majorant: an upper bound of the extinction coefficient.
class MajorantSteps {
 public:
  struct Step {
    float begin, end;       ///< distances along the ray
    SampledSpectrum sigma;  ///< the majorant, 1/unit
  };

  /// No piece: the ray does not meet the medium.
  MajorantSteps() = default;
  /// A single piece.
  MajorantSteps(float begin, float end, const SampledSpectrum& sigma) : begin_(begin), end_(end), sigma_(sigma) {}
  /// Pieces in the cells of a grid (pbrt 4th ed., 11.4.2). `ray` is in coordinates in which the grid's box is the unit
  /// cube; `sigma` is the extinction coefficient at density 1.
  MajorantSteps(const MajorantGrid& grid, const Ray& ray, float begin, float end, const SampledSpectrum& sigma);

  /// Writes the next piece to `step`; returns false after the last one.
  bool next(Step& step);

 private:
  float begin_ = 0, end_ = 0;
  SampledSpectrum sigma_;
  const MajorantGrid* grid_ = nullptr;
  std::array<float, 3> next_crossing_{}, delta_{};
  std::array<int, 3> cell_{}, direction_{};
};

/// Box in which a medium is defined, in the space of its own coordinates.
class MediumBox {
 public:
  MediumBox(const Bounds& bounds, const Transform& world_from_medium)
      : bounds_(bounds), medium_from_world_(world_from_medium.inverse()) {}

  const Bounds& bounds() const { return bounds_; }
  /// Transforms a point from world space to the medium's coordinates.
  Vec3 world_to_local(const Vec3& p) const { return medium_from_world_.point(p); }
  /// Position of a point of world space in the box: each coordinate is 0 to 1 within.
  Vec3 world_to_unit(const Vec3& p) const { return local_to_unit(world_to_local(p)); }
  Vec3 local_to_unit(const Vec3& local) const;
  /// Pieces of a ray of world space inside the box: one if `grid` is nullptr. `sigma` is the extinction coefficient at
  /// density 1.
  MajorantSteps steps(const Ray& ray, const MajorantGrid* grid, const SampledSpectrum& sigma) const {
    float begin, end;
    Ray in_box;
    if (!clip(ray, begin, end, in_box)) return {};
    return grid ? MajorantSteps(*grid, in_box, begin, end, sigma) : MajorantSteps(begin, end, sigma);
  }

 private:
  /// Clips a ray of world space to the box; returns false if they do not meet. `in_box` is the ray in coordinates in
  /// which the box is the unit cube; distances along both rays are the same.
  bool clip(const Ray& ray, float& begin, float& end, Ray& in_box) const;

  Bounds bounds_;
  Transform medium_from_world_;
};

}  // namespace frond
