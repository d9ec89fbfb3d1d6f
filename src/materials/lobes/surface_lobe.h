#pragma once

#include <limits>

#include "core/math/random.h"
#include "core/math/sampling.h"
#include "core/math/vec.h"
#include "leaf/tissue/lobe.h"

namespace frond {

/// Least |cos theta| of a direction that a leaf scatters, which avoids division by tiny cosines.
inline constexpr float kLeastCosine = 1e-20f;

inline bool leaf_scatters(const Vec3& wo, const Vec3& wi) {
  return std::abs(wo.z) >= kLeastCosine && std::abs(wi.z) >= kLeastCosine;
}

/// Returns (cos, sin) of 2 pi u, u in [0, 1]: Taylor series of half the angle, error 1e-6, normalised by a Newton step;
/// faster than library calls.
inline Vec2 unit_circle(float u) {
  const float a = kPi * (u - 0.5f), a2 = a * a;
  const float s =
      a * (1 + a2 * (-1.f / 6 + a2 * (1.f / 120 + a2 * (-1.f / 5040 + a2 * (1.f / 362880 - a2 * (1.f / 39916800))))));
  const float c = 1 + a2 * (-1.f / 2 + a2 * (1.f / 24 + a2 * (-1.f / 720 + a2 * (1.f / 40320 - a2 * (1.f / 3628800)))));
  const Vec2 d{2 * s * s - 1, -2 * s * c};
  return d * (1.5f - 0.5f * (d.x * d.x + d.y * d.y));
}

/// Lobe of a leaf's surface about the mirror direction: a power of the cosine, cut off at the surface and normalised
/// after the cut. The surface's share of the BSDF is F lobe_density(wo, wi) normalisation(incident) / |cos theta|, with
/// the cosine of the exitant direction.
class SurfaceLobe {
 public:
  /// `lobe` is not owned; nullptr only if no function is called.
  explicit SurfaceLobe(const leaf::Lobe* lobe) : lobe_(lobe) {}

  /// Density before the cut, 1/sr, symmetric in its directions; 0 if they are on different sides.
  float lobe_density(const Vec3& wo, const Vec3& wi) const {
    return wo.z * wi.z > 0 ? static_cast<float>(lobe_->density(dot(mirror(wo), wi))) : 0;
  }

  /// Normalisation after the cut, given the cosine of the mirrored direction.
  float normalisation(float cos_theta) const { return cut_at(cos_theta).normalisation; }

  /// Density of `sample`, 1/sr.
  float pdf(const Vec3& wo, const Vec3& wi) const { return lobe_density(wo, wi) * normalisation(wo.z); }

  /// Draws a direction on wo's side.
  Vec3 sample(const Vec3& wo, Vec2 u, RandomStream& rng) const {
    return lobe_->quantiles() ? sample_angles(wo, u, *lobe_->quantiles()) : sample_by_trials(wo, u, rng);
  }

 private:
  /// Terms that depend on the mirrored direction alone.
  struct Cut {
    float cos_theta = std::numeric_limits<float>::quiet_NaN();
    float kept, normalisation;
  };

  const Cut& cut_at(float cos_theta) const {
    if (cut_.cos_theta == cos_theta) return cut_;
    cut_.cos_theta = cos_theta;
    cut_.kept = static_cast<float>(lobe_->kept_share(std::abs(cos_theta)));
    cut_.normalisation = 1 / cut_.kept;
    return cut_;
  }

  Vec3 sample_angles(const Vec3& wo, Vec2 u, const leaf::LobeQuantiles& quantiles) const {
    const auto across = quantiles.across.at(u.y), along = quantiles.along.at(u.x * cut_at(wo.z).kept);
    const float sine = std::sqrt(wo.x * wo.x + wo.y * wo.y), cosine = std::abs(wo.z);
    const float forward = across.cosine * (along.sine * cosine + along.cosine * sine);
    const float up = across.cosine * (along.cosine * cosine - along.sine * sine);
    const Vec2 ahead = sine > 0 ? Vec2{wo.x, wo.y} * (-1 / sine) : Vec2{1, 0};
    return {forward * ahead.x - across.sine * ahead.y, forward * ahead.y + across.sine * ahead.x,
            std::copysign(std::max(up, kLeastCosine), wo.z)};
  }

  /// Rejection: the first trial uses `u`, later ones cheaper random numbers.
  Vec3 sample_by_trials(const Vec3& wo, Vec2 u, RandomStream& rng) const {
    const Frame frame = Frame::around(mirror(wo));
    const float side = std::copysign(1.f, wo.z);
    float cos_alpha = lobe_->cos_from_uniform(1 - u.x);
    for (;; cos_alpha = static_cast<float>(lobe_->sample_cos(rng.uniform_double(), rng)), u.y = rng.uniform()) {
      const float sin_alpha = std::sqrt(std::max(0.f, 1 - cos_alpha * cos_alpha));
      const Vec2 d = unit_circle(u.y);
      const Vec3 wi = frame.to_world({sin_alpha * d.x, sin_alpha * d.y, cos_alpha});
      if (side * wi.z >= kLeastCosine) return wi;
    }
  }

  static Vec3 mirror(const Vec3& w) { return {-w.x, -w.y, w.z}; }

  const leaf::Lobe* lobe_;
  mutable Cut cut_;  ///< cached, since calls come in turn for one direction
};

}  // namespace frond
