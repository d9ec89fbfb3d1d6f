#include "models/polygon.h"

#include <algorithm>
#include <cstddef>

namespace frond {
namespace {

/// Normal of the polygon, of twice its area (Newell's method).
Vec3d normal_of(const std::vector<Vec3d>& p) {
  Vec3d sum{};
  for (size_t i = 1; i + 1 < p.size(); ++i) sum = sum + cross(p[i] - p[0], p[i + 1] - p[0]);
  return sum;
}

}  // namespace

/// Ear clipping: an ear is a convex corner whose triangle contains no other corner.
std::vector<std::array<uint32_t, 3>> triangulated(const std::vector<Vec3d>& p) {
  const Vec3d normal = normal_of(p);
  std::vector<uint32_t> left(p.size());
  for (size_t i = 0; i < p.size(); ++i) left[i] = uint32_t(i);
  /// Twice the area of a triangle in the polygon's plane, below 0 at a concave corner.
  const auto area = [&](uint32_t a, uint32_t b, uint32_t c) { return dot(cross(p[b] - p[a], p[c] - p[a]), normal); };
  const auto corner = [&](size_t i) {
    const size_t n = left.size();
    return std::array{left[(i + n - 1) % n], left[i], left[(i + 1) % n]};
  };
  const auto is_ear = [&](size_t i) {
    const auto [a, b, c] = corner(i);
    if (!(area(a, b, c) > 0)) return false;
    return std::ranges::none_of(left, [&, a = a, b = b, c = c](uint32_t q) {
      const bool is_corner =
          p[q] == p[a] || p[q] == p[b] || p[q] == p[c];  // of an edge to a hole, which is there twice
      return !is_corner && area(a, b, q) >= 0 && area(b, c, q) >= 0 && area(c, a, q) >= 0;
    });
  };
  std::vector<std::array<uint32_t, 3>> triangles;
  const auto is_convex_at = [&](size_t i) {
    const auto [a, b, c] = corner(i);
    return area(a, b, c) >= 0;
  };
  bool is_convex = true;
  for (size_t i = 0; i < left.size() && is_convex; ++i) is_convex = is_convex_at(i);
  for (size_t i = 0, tried = 0; !is_convex && left.size() > 3 && tried < left.size();) {
    i %= left.size();
    if (is_ear(i)) {
      triangles.push_back(corner(i));
      left.erase(left.begin() + std::ptrdiff_t(i));
      tried = 0;
    } else {
      ++i, ++tried;
    }
  }
  for (size_t i = 1; i + 1 < left.size(); ++i) triangles.push_back({left[0], left[i], left[i + 1]});
  return triangles;
}

}  // namespace frond
