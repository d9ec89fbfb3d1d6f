#include "textures/texture_mapping.h"

#include <algorithm>

namespace frond {

TextureMapping::TextureMapping(const Params& p, const TexturePlacement& placement)
    : scale_{float(p.real("uscale")), float(p.real("vscale"))},
      delta_{float(p.real("udelta")), float(p.real("vdelta"))},
      v1_(p.vec3("v1")),
      v2_(p.vec3("v2")),
      texture_from_world_(placement.world_from_texture.inverse()) {
  kind_ = Kind(std::ranges::find(kMappings, p.string("mapping")) - std::begin(kMappings));
}

/// Computes coordinates and, by the gradients, their change over the footprint.
TextureCoordinates TextureMapping::of_point(const TexturePoint& point) const {
  const Vec3 p = texture_from_world_.point(point.p);
  Vec2 st;
  Vec3 ds, dt;  // gradients
  // Formulas of pbrt (4th ed., 10.2), with analytic gradients.
  if (kind_ == Kind::planar) {
    ds = v1_, dt = v2_;
    st = Vec2{dot(p, v1_), dot(p, v2_)} + delta_;
  } else {
    const float square = p.x * p.x + p.y * p.y, radius = std::sqrt(square), turn = 0.5f * kInvPi;
    // On the axis the azimuth has no gradient: it is taken as 0, without filtering.
    const bool on_axis = !(square > 0);
    const float phi = std::atan2(p.y, p.x);
    const Vec3 around = on_axis ? Vec3{} : Vec3{-p.y, p.x, 0} * (turn / square);
    if (kind_ == Kind::cylindrical) {
      ds = around, dt = {0, 0, 1};
      st = {0.5f + phi * turn, p.z};
    } else {
      // As in pbrt-v4, s runs from pole to pole, and t around the axis.
      const float whole = square + p.z * p.z;
      if (!on_axis) ds = Vec3{p.x * p.z / radius, p.y * p.z / radius, -radius} * (kInvPi / whole);
      dt = around;
      st = {std::atan2(radius, p.z) * kInvPi, (phi < 0 ? phi + 2 * kPi : phi) * turn};
    }
  }
  const auto change = [&](const Vec3& world) {
    const Vec3 step = texture_from_world_.vector(world);
    return Vec2{dot(ds, step), dot(dt, step)};
  };
  return {st, change(point.dp_dx), change(point.dp_dy)};
}

}  // namespace frond
