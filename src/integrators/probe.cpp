#include "integrators/probe.h"

#include "integrators/path_parts.h"

namespace frond {

/// Chooses one intersection by reservoir sampling (Chao 1982), as their number is known at the end. Distances are those
/// of points on the ray: on large triangles the points of hits are off by more than a mean free path.
bool find_exit(const World& world, const Bssrdf& bssrdf, uint32_t material_id, float uc, Vec2 u, VertexKey key,
               float time, uint64_t& rays, MaterialExit& exit) {
  const auto segment = bssrdf.sample(uc, u);
  if (!segment) return false;
  RandomStream random = key.stream(Use::bsdf);
  const float whole = length(segment->to - segment->from);
  if (!(whole > 0 && whole < INFINITY)) return false;
  Ray ray{segment->from, (segment->to - segment->from) / whole, whole, time};
  int found = 0;
  Vec3 on_ray;
  SurfacePoint point;
  for (int i = 0; i < kMostPassed && ray.t_max > 0; ++i) {
    ++rays;
    if (!world.intersect(ray, key.key(Use::ray, i), point)) break;
    if (point.material_id == material_id && random.uniform() * float(++found) < 1) {
      exit.point = point;
      on_ray = ray.o + ray.d * dot(point.hit.p - ray.o, ray.d);
    }
    ray.o = offset_origin(point.hit, ray.d);
    ray.t_max = dot(segment->to - ray.o, ray.d);
  }
  if (found == 0) return false;
  Hit hit = exit.point.hit;
  hit.p = on_ray;
  exit.weight = bssrdf.weight(hit) * float(found);
  return !exit.weight.is_black();
}

}  // namespace frond
