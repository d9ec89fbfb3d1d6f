#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/random.h"
#include "core/math/sampling.h"
#include "core/spectrum.h"

namespace frond {

/// Phase function of Henyey and Greenstein (1941), 1/sr. `cosine`: of the angle between the directions of travel before
/// and after; `g`: mean cosine.
inline float henyey_greenstein(float cosine, float g) {
  const float base = std::max(1 + g * g - 2 * g * cosine, 1e-8f);
  return (1 - g * g) / (4 * kPi * base * std::sqrt(base));
}

/// Samples a direction of travel with the density henyey_greenstein; `w` is the one before.
inline Vec3 sample_henyey_greenstein(const Vec3& w, float g, Vec2 u) {
  float cosine = 1 - 2 * u.x;
  if (std::abs(g) > 1e-3f) {
    const float ratio = (1 - g * g) / (1 + g - 2 * g * u.x);
    cosine = std::clamp((1 + g * g - ratio * ratio) / (2 * g), -1.f, 1.f);
  }
  const float sine = std::sqrt(std::max(0.f, 1 - cosine * cosine)), phi = 2 * kPi * u.y;
  return Frame::around(w).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
}

/// Phase function: distribution of the direction after a scattering in a medium. Its arguments are directions of
/// travel, before and after; it depends on the angle between them.
class Phase {
 public:
  Phase() : Phase(henyey_greenstein(0)) {}
  /// Henyey and Greenstein 1941; `g` is the mean cosine, above 0 for forward scattering.
  static Phase henyey_greenstein(float g) { return {false, std::clamp(g, -0.99f, 0.99f), {}}; }
  /// Bi-Lambertian leaves whose normals point in all directions alike (Ross 1981, The Radiation Regime and Architecture
  /// of Plant Stands). `reflected`: R / (R + T), the share of scattered light that leaves on the side it came from.
  static Phase bi_lambertian(const SampledSpectrum& reflected) { return {true, 0, reflected}; }

  /// Density, 1/sr, in each lane for the cosine of the angle between the two directions.
  SampledSpectrum value(float cosine) const {
    if (!is_bi_lambertian_) return SampledSpectrum(frond::henyey_greenstein(cosine, g_));
    const float back = reflection_density(cosine), front = reflection_density(-cosine);
    return SampledSpectrum(front) + reflected_ * (back - front);
  }
  /// Samples a direction with the density of lane `lane`. `w` is the direction before.
  Vec3 sample(const Vec3& w, int lane, Vec2 u, RandomStream& rng) const {
    return is_bi_lambertian_ ? sample_leaf(w, lane, u, rng) : sample_henyey_greenstein(w, g_, u);
  }

 private:
  Phase(bool is_bi_lambertian, float g, const SampledSpectrum& reflected)
      : is_bi_lambertian_(is_bi_lambertian), g_(g), reflected_(reflected) {}

  /// Density of leaves that only reflect: 2 (sin b - b cos b) / (3 pi^2) for the angle b.
  static float reflection_density(float cosine) {
    const float c = std::clamp(cosine, -1.f, 1.f);
    return 2 / (3 * kPi * kPi) * (std::sqrt(1 - c * c) - std::acos(c) * c);
  }
  /// Samples a leaf that the ray meets, in proportion to the area that it sees, then Lambert's law on one side.
  Vec3 sample_leaf(const Vec3& w, int lane, Vec2 u, RandomStream& rng) const {
    const float cosine = std::sqrt(rng.uniform()), sine = std::sqrt(1 - cosine * cosine), phi = 2 * kPi * rng.uniform();
    const Vec3 normal = Frame::around(-w).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
    const bool is_reflected = rng.uniform() < reflected_[lane];
    return Frame::around(is_reflected ? normal : -normal).to_world(sample_cosine_hemisphere(u));
  }

  bool is_bi_lambertian_;
  float g_;
  SampledSpectrum reflected_;
};

}  // namespace frond
