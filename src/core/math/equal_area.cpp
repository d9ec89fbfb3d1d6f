#include "core/math/equal_area.h"

namespace frond {

Vec3 sphere_from_square(Vec2 uv) {
  const float x = 2 * uv.x - 1, y = 2 * uv.y - 1, ax = std::abs(x), ay = std::abs(y);
  const float d = 1 - (ax + ay), r = 1 - std::abs(d);
  // The azimuth is linear along a height's diamond from y = 0 to x = 0. The lower hemisphere is folded over the edge d
  // = 0, where (x, y) corresponds to (1 - y, 1 - x) above.
  const float along = d >= 0 ? ay : 1 - ax, phi = r > 0 ? along / r * (kPi / 2) : kPi / 4;
  const float ring = r * std::sqrt(std::max(0.f, 2 - r * r));
  return {std::copysign(std::cos(phi), x) * ring, std::copysign(std::sin(phi), y) * ring, std::copysign(1 - r * r, d)};
}

Vec2 square_from_sphere(const Vec3& d) {
  const float ax = std::abs(d.x), ay = std::abs(d.y), r = std::sqrt(std::max(0.f, 1 - std::abs(d.z)));
  const float phi = ax == 0 && ay == 0 ? 0 : std::atan2(ay, ax) * 2 * kInvPi;
  float v = phi * r, u = r - v;
  if (d.z < 0) {
    const float swapped = 1 - v;
    v = 1 - u;
    u = swapped;
  }
  return {(std::copysign(u, d.x) + 1) / 2, (std::copysign(v, d.y) + 1) / 2};
}

/// Leaving by one edge enters by the same edge, mirrored about its middle.
Vec2 wrapped_on_square(Vec2 uv) {
  if (uv.x < 0 || uv.x > 1) uv = {uv.x < 0 ? -uv.x : 2 - uv.x, 1 - uv.y};
  if (uv.y < 0 || uv.y > 1) uv = {1 - uv.x, uv.y < 0 ? -uv.y : 2 - uv.y};
  return uv;
}

}  // namespace frond
