#pragma once

#include "scene/textures/texture_mapping.h"

namespace frond {

/// Perlin's gradient noise, "Improving Noise" 2002: 0 at points of whole numbers, between -1 and 1, of period 256.
float perlin_noise(const Vec3& p);

/// Noise at frequencies that grow by 1.99, each `gain` times as strong as the last. Those whose waves are shorter than
/// twice the footprint are left out: pbrt 4th ed., 10.7 of the online edition.
float fractal_noise(const SolidCoordinates& at, float gain, int octaves);
/// Of magnitudes: what is left out counts with its mean, 0.2, and the first of that twice, as in pbrt-v4.
float turbulence(const SolidCoordinates& at, float gain, int octaves);

/// What neither exceeds.
double largest_sum(double gain, int octaves);

}  // namespace frond
