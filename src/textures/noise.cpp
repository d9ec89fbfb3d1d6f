#include "textures/noise.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace frond {
namespace {

/// Perlin's permutation table.
constexpr std::array<uint8_t, 256> kPermutation{
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

int permuted(int i) { return kPermutation[size_t(i & 255)]; }

/// Returns the dot product of the offset and a gradient toward an edge of the cube.
float gradient_dot(int x, int y, int z, const Vec3& offset) {
  const int h = permuted(permuted(permuted(x) + y) + z) & 15;
  const float u = h < 8 || h == 12 || h == 13 ? offset.x : offset.y;
  const float v = h < 4 || h == 12 || h == 13 ? offset.y : offset.z;
  return ((h & 1) != 0 ? -u : u) + ((h & 2) != 0 ? -v : v);
}

float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }
float lerp(float t, float a, float b) { return (1 - t) * a + t * b; }
/// Cubic interpolation from 0 to 1.
float smooth_step(float x, float from, float to) {
  const float t = std::clamp((x - from) / (to - from), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

/// Returns the number of octaves above the footprint's limit.
float resolved_octaves(const SolidCoordinates& at, int octaves) {
  const float square = std::max(dot(at.dp_dx, at.dp_dx), dot(at.dp_dy, at.dp_dy));
  return std::clamp(-1 - std::log2(square) / 2, 0.f, float(octaves));
}

}  // namespace

/// Coordinates are reduced modulo the period; values that are not finite count as 0.
float perlin_noise(const Vec3& p) {
  const auto in_period = [](float x) { return std::isfinite(x) ? std::fmod(x, 256.f) : 0.f; };
  const Vec3 at{in_period(p.x), in_period(p.y), in_period(p.z)};
  const float fx = std::floor(at.x), fy = std::floor(at.y), fz = std::floor(at.z);
  const int x = int(fx), y = int(fy), z = int(fz);
  const Vec3 d{at.x - fx, at.y - fy, at.z - fz};
  const auto corner = [&](int i, int j, int k) {
    return gradient_dot(x + i, y + j, z + k, d - Vec3{float(i), float(j), float(k)});
  };
  const float wx = fade(d.x), wy = fade(d.y), wz = fade(d.z);
  const auto layer = [&](int k) {
    return lerp(wy, lerp(wx, corner(0, 0, k), corner(1, 0, k)), lerp(wx, corner(0, 1, k), corner(1, 1, k)));
  };
  return lerp(wz, layer(0), layer(1));
}

namespace {

/// Sums `value` of each octave's noise; omitted octaves contribute `absent`.
template <class Value>
float sum_of_octaves(const SolidCoordinates& at, float gain, int octaves, float absent, const Value& value) {
  const float left = resolved_octaves(at, octaves);
  const int last = int(left);  // this octave fades out
  float sum = 0, weight = 1, frequency = 1;
  for (int i = 0; i <= last; ++i, frequency *= 1.99f) {
    if (i > 0) weight *= gain;
    sum += weight * lerp(smooth_step(left - float(i), 0.3f, 0.7f), absent, value(perlin_noise(at.p * frequency)));
  }
  for (int i = last; i < octaves; ++i, weight *= gain) sum += weight * absent;
  return sum;
}

}  // namespace

float fractal_noise(const SolidCoordinates& at, float gain, int octaves) {
  return sum_of_octaves(at, gain, octaves, 0, [](float noise) { return noise; });
}

float turbulence(const SolidCoordinates& at, float gain, int octaves) {
  constexpr float kMean = 0.2f;
  return sum_of_octaves(at, gain, octaves, kMean, [](float noise) { return std::abs(noise); });
}

/// Sum of the octaves' largest amplitudes.
double largest_sum(double gain, int octaves) {
  double sum = 0, weight = 1;
  for (int i = 0; i <= octaves; ++i, weight *= std::abs(gain)) sum += weight;
  return sum;
}

}  // namespace frond
