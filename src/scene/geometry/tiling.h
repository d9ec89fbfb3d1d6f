#pragma once

#include <optional>

#include "core/math/ray.h"
#include "core/shape.h"

namespace frond {

/// Periodic repetition of a scene along x and y.
class Tiling {
 public:
  /// `period`: along x and y, above 0. `bounds`: of the scene; may exceed a period.
  Tiling(Vec2 period, const Bounds& bounds);

  /// A repetition of the scene: its offset, and the ray in its space.
  struct Repeat {
    Vec3 shift;
    Ray ray;         ///< limited to the segment within the cell
    float distance;  ///< distance along the ray to the start of the segment
  };
  /// Calls `meets(repeat)` for all repetitions that overlap the cells along the ray, nearest cell first. Returns true
  /// after the first cell with a call that returned true. After kMostCells cells the ray counts as leaving the scene.
  template <class Meets>
  bool march(const Ray& ray, const Meets& meets) const;

 private:
  static constexpr int kMostCells = 10000;
  /// Share of the period by which segments within cells are enlarged, so that surfaces on their borders are not missed.
  static constexpr double kSlack = 1e-5;

  /// Repetition along x or y.
  struct Axis {
    double period, least;
    double width;  ///< of the scene; may exceed the period
    int overlap;   ///< number of preceding repetitions that overlap a cell

    /// Index of the cell of x: an integer, possibly very large.
    double cell(double x) const { return std::floor((x - least) / period); }
    /// Whether a segment within a cell, from `from` to `to`, reaches the part of the cell that the repetition which
    /// begins `back` cells before it covers.
    bool reaches(double from, double to, double cell, int back) const {
      return std::min(from, to) - (least + cell * period) <= width - back * period + kSlack * period;
    }
    /// Returns the distance at which a ray leaves the cell; infinity if it does not.
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
  const double slack = kSlack * std::max(x_.period, y_.period) / std::max(1e-30, length(d));
  double i = x_.cell(o.x + t * d.x), j = y_.cell(o.y + t * d.y);
  for (int cells = 0; cells < kMostCells && t < end; ++cells) {
    const double exit_x = x_.exit(o.x, d.x, i), exit_y = y_.exit(o.y, d.y, j);
    const double exit = std::min({exit_x, exit_y, end}), enter = std::max(0.0, t - slack);
    const Vec3d from = o + d * enter, to = o + d * (exit + slack);
    bool met = false;
    for (int a = 0; a <= x_.overlap; ++a) {
      if (!x_.reaches(from.x, to.x, i, a)) break;
      for (int b = 0; b <= y_.overlap; ++b) {
        if (!y_.reaches(from.y, to.y, j, b)) break;
        const Vec3d shift{(i - a) * x_.period, (j - b) * y_.period, 0};
        const Ray there{to_float(from - shift), ray.d, float(std::min(exit + slack, double(ray.t_max)) - enter),
                        ray.time};
        met |= meets(Repeat{to_float(shift), there, float(enter)});
      }
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
