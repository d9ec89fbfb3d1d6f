#pragma once

#include "core/vec.h"

namespace frond {

/// Equal-area map between the unit square and the sphere: the octahedron's faces side by side (Clarberg 2008, "Fast
/// Equal-Area Mapping of the (Hemi)Sphere using SIMD").
Vec3 sphere_from_square(Vec2 uv);
/// Of a unit direction.
Vec2 square_from_sphere(const Vec3& d);
/// The place in the square that lies where one beyond its edge would: edges are sewn to themselves, half by half.
Vec2 wrapped_on_square(Vec2 uv);

}  // namespace frond
