#include "scene/geometry/tiling.h"

namespace frond {

/// `overlap` is 0 for a scene that fits into its period.
Tiling::Tiling(Vec2 period, const Bounds& bounds) {
  const auto axis = [](float length, float least, float most) {
    const double width = std::max(0.0, double(most) - double(least));
    constexpr double kRounding = 1e-6;
    return Axis{double(length), double(least), width,
                std::max(0, int(std::ceil(width / double(length) - kRounding)) - 1)};
  };
  x_ = axis(period.x, bounds.min.x, bounds.max.x);
  y_ = axis(period.y, bounds.min.y, bounds.max.y);
  // A flat scene has no height: the slab is enlarged.
  const double slack =
      1e-5 * std::max({x_.period, y_.period, std::abs(double(bounds.min.z)), std::abs(double(bounds.max.z))});
  bottom_ = double(bounds.min.z) - slack;
  top_ = double(bounds.max.z) + slack;
}

}  // namespace frond
