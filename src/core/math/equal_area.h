#pragma once

#include "core/math/vec.h"

namespace frond {

/// Equal-area map from the unit square to the sphere (Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using
/// SIMD").
Vec3 sphere_from_square(Vec2 uv);
/// Inverse of sphere_from_square, for a unit direction.
Vec2 square_from_sphere(const Vec3& d);
/// Wraps a point beyond the square's edge to the point of the square with the same direction (octahedral wrapping).
Vec2 wrapped_on_square(Vec2 uv);

}  // namespace frond
