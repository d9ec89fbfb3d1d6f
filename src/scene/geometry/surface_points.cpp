#include "scene/geometry/surface_points.h"

#include <algorithm>
#include <cmath>

#include "core/math/random.h"
#include "core/stop.h"

namespace frond {
namespace {

/// Mean factor of a map on areas, over all orientations: exact if the map preserves angles. Weights hold the rest.
double area_factor(const AffineMap& map) {
  const Vec3 x = map.vector({1, 0, 0}), y = map.vector({0, 1, 0}), z = map.vector({0, 0, 1});
  const double volume = double(dot(x, cross(y, z)));
  return std::cbrt(volume * volume);
}

}  // namespace

RandomSurfacePoint surface_point(const ShapeEmitter& emitter, Vec2 u, const AffineMap& map, double area) {
  const auto sample = emitter.sample(u);
  const Vec3& own = sample.point.p;
  const Vec3 ng = map.normal(sample.point.ng), p = map.point(own);
  const Vec3 reach = map.bound_point({std::abs(own.x), std::abs(own.y), std::abs(own.z)});
  const double alpha = std::clamp(double(emitter.opacity({own, sample.point.ng, sample.uv})), 0.0, 1.0);
  return {p, normalize_any(ng), largest_coordinate(reach), alpha * double(sample.weight) * double(length(ng)) / area};
}

SurfacePoints::SurfacePoints(const Geometry& geometry, std::span<const uint8_t> is_counted) : geometry_(geometry) {
  StopPoll poll;
  geometry.visit_surfaces([&](const Surface& surface, const AffineMap&, uint64_t) {
    poll();
    if (is_counted[surface.material]) emitters_.try_emplace(&surface, surface);
  });
  visit([this](const ShapeEmitter& emitter, const AffineMap&, double factor) { total_ += factor * emitter.area(); });
}

template <class Visit>
void SurfacePoints::visit(const Visit& visit) const {
  StopPoll poll;
  geometry_.visit_surfaces([&](const Surface& surface, const AffineMap& map, uint64_t) {
    poll();
    const auto emitter = emitters_.find(&surface);
    if (emitter != emitters_.end()) visit(emitter->second, map, area_factor(map));
  });
}

/// Sorts positions along the cumulative area of all surfaces, then traverses these once.
std::vector<RandomSurfacePoint> SurfacePoints::draw(uint64_t key, uint64_t first, size_t count) const {
  struct Position {
    double at;
    uint64_t index;
  };
  std::vector<Position> positions;
  for (uint64_t i = first; i < first + count; ++i)
    positions.push_back({RandomStream(hash_key(key, i)).uniform_double() * total_, i});
  std::ranges::sort(positions, {}, &Position::at);
  std::vector<RandomSurfacePoint> points(count);
  double end = 0;
  size_t next = 0;
  visit([&](const ShapeEmitter& emitter, const AffineMap& map, double factor) {
    end += factor * emitter.area();
    for (; next < count && positions[next].at < end; ++next) {
      const uint64_t index = positions[next].index;
      RandomStream random(hash_key(key, index, uint64_t{1}));
      const float u = random.uniform();
      points[index - first] = surface_point(emitter, {u, random.uniform()}, map, factor);
    }
  });
  return points;
}

}  // namespace frond
