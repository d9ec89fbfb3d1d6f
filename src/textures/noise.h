#pragma once

#include "textures/texture_mapping.h"

namespace frond {

/// Perlin's gradient noise ("Improving Noise", 2002): 0 at integer points, range -1 to 1, period 256.
float perlin_noise(const Vec3& p);

/// Sum of noise octaves whose frequencies grow by 1.99 and whose amplitudes fall by `gain`. Octaves with wavelengths
/// below twice the footprint are omitted (pbrt 4th ed., 10.7 of the online edition).
float fractal_noise(const SolidCoordinates& at, float gain, int octaves);
/// Sum of magnitudes of octaves. Omitted octaves count as their mean, 0.2; the first of them twice, as in pbrt-v4.
float turbulence(const SolidCoordinates& at, float gain, int octaves);

/// Returns an upper bound of both functions.
double largest_sum(double gain, int octaves);

}  // namespace frond
