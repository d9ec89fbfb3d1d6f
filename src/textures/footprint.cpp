#include "textures/footprint.h"

namespace frond {
namespace {

/// Infinite vectors are replaced by the first finite one.
void keep_shorter(Vec3& shortest, const Vec3& v) {
  if (dot(v, v) < dot(shortest, shortest)) shortest = v;
}

/// Least-squares change of (u, v) that moves the point by `step`.
Vec2 uv_of(const SurfaceDerivatives& d, const Vec3& step) {
  const float uu = dot(d.dpdu, d.dpdu), uv = dot(d.dpdu, d.dpdv), vv = dot(d.dpdv, d.dpdv);
  const float du = dot(d.dpdu, step), dv = dot(d.dpdv, step), det = uu * vv - uv * uv;
  // A degenerate parameterization does not filter; the bound keeps products with the change finite.
  const auto bounded = [det](float x) { return std::isfinite(x / det) ? std::clamp(x / det, -1e8f, 1e8f) : 0; };
  return {bounded(vv * du - uv * dv), bounded(uu * dv - uv * du)};
}

}  // namespace

Footprint::Footprint(const Camera& camera, const CameraPlacement& placement, bool between_samples)
    : camera_from_world_(placement.world_from_camera.inverse()), is_point_(false) {
  const float pixels = between_samples ? 0.125f : 1.f;
  // Uses the shortest steps over the film, so that textures are sharp rather than blurred.
  // Rays along the film's diagonal, from corner to corner.
  constexpr int kPlaces = 512;
  const Vec2 lens{0.5f, 0.5f};
  const auto direction = [this](const Ray& ray) { return normalize_any(camera_from_world_.vector(ray.d)); };
  const auto origin = [this](const Ray& ray) { return camera_from_world_.point(ray.o); };
  for (int i = 0; i < kPlaces; ++i) {
    const float at = float(i) / float(kPlaces - 1);
    const Vec2 film{at * float(placement.width), at * float(placement.height)};
    const Ray here = camera.ray(film, lens);
    const Frame frame = Frame::around(direction(here));
    const auto keep = [&](const Ray& next, Step& shortest) {
      keep_shorter(shortest.origin, (origin(next) - origin(here)) * pixels);
      keep_shorter(shortest.direction, (frame.to_local(direction(next)) - Vec3{0, 0, 1}) * pixels);
    };
    keep(camera.ray({film.x + 1, film.y}, lens), x_);
    keep(camera.ray({film.x, film.y + 1}, lens), y_);
  }
}

void Footprint::set(Hit& hit) const {
  TexturePoint& at = hit.at;
  at.p = hit.p, at.n = hit.shading.z;
  if (is_point_) {
    at.dp_dx = at.dp_dy = {}, at.duv_dx = at.duv_dy = {};
    return;
  }
  // In a space where the camera looks along z at the point, rays of neighbouring samples intersect the tangent plane.
  const Vec3 p = camera_from_world_.point(hit.p);
  const float distance = length(p);
  const Frame frame = Frame::around(distance > 0 ? p / distance : Vec3{0, 0, 1});
  const Transform world_from_camera = camera_from_world_.inverse();
  const Vec3 n = frame.to_local(normalize_any(world_from_camera.normal(hit.ng)));
  const auto step = [&](const Step& s) {
    const Vec3 d = Vec3{0, 0, 1} + s.direction;
    const float t = (n.z * distance - dot(n, s.origin)) / dot(n, d);
    const Vec3 by = s.origin + d * t - Vec3{0, 0, distance};
    return std::isfinite(dot(by, by)) ? world_from_camera.vector(frame.to_world(by)) : Vec3{};
  };
  at.dp_dx = step(x_), at.dp_dy = step(y_);
  at.duv_dx = uv_of(hit.derivatives, at.dp_dx), at.duv_dy = uv_of(hit.derivatives, at.dp_dy);
}

}  // namespace frond
