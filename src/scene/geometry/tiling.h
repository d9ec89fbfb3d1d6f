#pragma once

#include <optional>

#include "core/ray.h"
#include "core/shape.h"

namespace frond {

/// A scene that is repeated periodically along x and y.
class Tiling {
 public:
  /// `period`: along x and y, above 0. `bounds`: of the scene; they may be larger than a period.
  Tiling(Vec2 period, const Bounds& bounds);

  /// The scene, repeated in a cell: where it has been moved to, and where a ray goes there.
  struct Repeat {
    Vec3 shift;
    Ray ray;         ///< in the space of the repeat, from where it enters its cell to where it leaves it
    float distance;  ///< along the ray, of where it enters
  };
  /// Calls `meets(repeat)` for those that reach into the cells that a ray passes, cell by cell from the nearest, until
  /// a cell had one for which it returned true; then so does this. A ray that has passed kMostCells in vain has left
  /// the scene.
  template <class Meets>
  bool march(const Ray& ray, const Meets& meets) const;

 private:
  static constexpr int kMostCells = 10000;

  /// Along x or y.
  struct Axis {
    double period, least;
    int overlap;  ///< how many repeats before a cell's own reach into it

    /// A whole number, maybe a very large one.
    double cell(double x) const { return std::floor((x - least) / period); }
    /// Where a ray leaves a cell; infinity where it never does.
    double exit(double o, double d, double cell) const {
      if (d == 0) return INFINITY;
      return (least + period * (d > 0 ? cell + 1 : cell) - o) / d;
    }
  };

  Axis x_, y_;
  double bottom_, top_;
};

template <class Meets>
bool Tiling::march(const Ray& ray, const Meets& meets) const {
  const Vec3d o = to_double(ray.o), d = to_double(ray.d);
  double t = 0, end = double(ray.t_max);
  if (d.z == 0) {
    if (o.z < bottom_ || o.z > top_) return false;
  } else {
    const double a = (bottom_ - o.z) / d.z, b = (top_ - o.z) / d.z;
    t = std::max(t, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(t < end)) return false;
  // The way through a cell, a little longer than it is: what lies on its border must not be missed.
  const double slack = 1e-5 * std::max(x_.period, y_.period) / std::max(1e-30, length(d));
  double i = x_.cell(o.x + t * d.x), j = y_.cell(o.y + t * d.y);
  for (int cells = 0; cells < kMostCells && t < end; ++cells) {
    const double exit_x = x_.exit(o.x, d.x, i), exit_y = y_.exit(o.y, d.y, j);
    const double exit = std::min({exit_x, exit_y, end}), enter = std::max(0.0, t - slack);
    bool met = false;
    for (int a = 0; a <= x_.overlap; ++a)
      for (int b = 0; b <= y_.overlap; ++b) {
        const Vec3d shift{(i - a) * x_.period, (j - b) * y_.period, 0};
        const Ray there{to_float(o + d * enter - shift), ray.d,
                        float(std::min(exit + slack, double(ray.t_max)) - enter)};
        met |= meets(Repeat{to_float(shift), there, float(enter)});
      }
    if (met) return true;
    t = std::max(t, exit);
    if (exit_x <= exit_y)
      i += d.x > 0 ? 1 : -1;
    else
      j += d.y > 0 ? 1 : -1;
  }
  return false;
}

}  // namespace frond
