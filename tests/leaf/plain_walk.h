#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "leaf/walk/walk.h"

namespace frond::test {

/// The random walk as the model's description states it, in double precision, one ray at a time. It shares only the
/// description of the tissue with the program. Reference for results and speed of the fast walks.
class PlainWalk {
 public:
  PlainWalk(const leaf::Tissue& tissue, uint64_t seed) : tissue_(tissue), random_(seed) {}

  /// A ray that comes from `wo`, absorbed or not as a whole.
  leaf::WalkEnd operator()(const Vec3d& wo) {
    Vec3d v = -wo;
    int interface = v.z < 0 ? 0 : 5;
    const double place = tissue_.air_space_moves ? uniform() : 0;
    for (int event = 0;; ++event) {
      const bool up = v.z > 0;
      const int from = up ? interface + 1 : interface, to = up ? interface : interface + 1;
      if (event > 0 && absorbed(thickness(from, place), std::abs(v.z))) return {leaf::Fate::absorbed, v, 0};

      const double n_from = tissue_.n[size_t(from)], n_to = tissue_.n[size_t(to)];
      const bool refracted = uniform() >= fresnel(n_from, n_to, std::abs(v.z));
      v = refracted ? refract(v, n_from / n_to) : Vec3d{v.x, v.y, -v.z};
      if (const leaf::Lobe* lobe = tissue_.lobe(size_t(interface), up, refracted)) v = perturb(v, lobe->exponent());

      interface += v.z > 0 ? -1 : 1;
      if (interface >= 0 && interface <= 5) continue;
      if (event == 0) return {leaf::Fate::surface, v, 1};
      return {v.z * wo.z > 0 ? leaf::Fate::reflected : leaf::Fate::transmitted, v, 1};
    }
  }

 private:
  /// In [0, 1).
  double uniform() { return double(random_() >> 11) * 0x1p-53; }

  double thickness(int medium, double place) const {
    const double whole = tissue_.optical_depth[size_t(medium)];
    if (!tissue_.air_space_moves) return whole;
    return medium == 2 ? whole * place : whole * (1 - place);
  }

  /// Beer's law: the free path ends within the medium.
  bool absorbed(double depth, double cosine) {
    if (depth == 0) return false;
    return -std::log(1 - uniform()) * (tissue_.sieve_and_detour ? std::cos(cosine) : cosine) < depth;
  }

  /// Reflectance for unpolarised light.
  static double fresnel(double n1, double n2, double cos_i) {
    const double sin_t = n1 / n2 * std::sqrt(std::max(0.0, 1 - cos_i * cos_i));
    if (sin_t >= 1) return 1;
    const double cos_t = std::sqrt(1 - sin_t * sin_t);
    const double s = (n1 * cos_i - n2 * cos_t) / (n1 * cos_i + n2 * cos_t);
    const double p = (n1 * cos_t - n2 * cos_i) / (n1 * cos_t + n2 * cos_i);
    return (s * s + p * p) / 2;
  }

  static Vec3d refract(const Vec3d& v, double ratio) {
    const double x = v.x * ratio, y = v.y * ratio;
    return {x, y, std::copysign(std::sqrt(1 - x * x - y * y), v.z)};
  }

  /// Turns `w` by alpha and beta, anew until it stays on its side.
  Vec3d perturb(const Vec3d& w, double exponent) {
    const Vec3d other = std::abs(w.x) > 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    const Vec3d tangent = normalize(cross(other, w)), bitangent = cross(w, tangent);
    for (;;) {
      const double cos_alpha = std::pow(1 - uniform(), 1 / (exponent + 1)), beta = 2 * std::numbers::pi * uniform();
      const double sin_alpha = std::sqrt(1 - cos_alpha * cos_alpha);
      const Vec3d v = tangent * (sin_alpha * std::cos(beta)) + bitangent * (sin_alpha * std::sin(beta)) + w * cos_alpha;
      if (v.z * w.z > 0) return normalize(v);
    }
  }

  const leaf::Tissue& tissue_;
  std::mt19937_64 random_;
};

}  // namespace frond::test
