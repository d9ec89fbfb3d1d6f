#pragma once

#include <algorithm>
#include <cmath>

#include "core/bsdf.h"
#include "core/material.h"

namespace frond {

/// A BSDF at a hit, in world space. The shading normal alone decides the side of a direction, as in pbrt-v4 and
/// Mitsuba: the BSDF keeps all of its energy, however far that normal is from the geometric one.
class LocalBsdf {
 public:
  /// Sets the members in place: a struct that was just written field by field cannot be copied until those writes reach
  /// the cache.
  void set(const Bsdf& bsdf, const Hit& hit, const Vec3& wo) {
    bsdf_ = &bsdf;
    frame_ = hit.shading;
    wo_ = frame_.to_local(wo);
  }

  /// Returns f |cos theta_i|, 1/sr, and stores the BSDF's density for wi, 1/sr, in `pdf`.
  SampledSpectrum f_cos(const Vec3& wi_world, RandomStream rng, float& pdf) const {
    const Vec3 wi = frame_.to_local(wi_world);
    pdf = bsdf_->pdf(wo_, wi);
    return pdf > 0 ? bsdf_->f(wo_, wi, rng) * std::abs(wi.z) : SampledSpectrum();
  }

  /// A sampled direction.
  struct Sample {
    Vec3 wi;                 ///< world space
    SampledSpectrum weight;  ///< f |cos theta_i| / pdf
    float pdf;               ///< 1/sr, for MIS with light sampling
    float eta_scale;         ///< eta^2: the factor by which refraction has divided the weight
    bool is_specular;
  };
  /// Samples a direction into `sample`; returns false if nothing is scattered.
  bool sample(float uc, Vec2 u, RandomStream rng, Sample& sample) const {
    const auto s = bsdf_->sample(wo_, uc, u, rng);
    if (!s) return false;
    sample.wi = frame_.to_world(s->wi);
    sample.weight = s->f * (std::abs(s->wi.z) / s->pdf);
    sample.eta_scale = s->eta * s->eta;
    sample.is_specular = any(s->flags & Lobes::specular);
    sample.pdf = s->pdf_is_approximate && !sample.is_specular ? bsdf_->pdf(wo_, s->wi) : s->pdf;
    return true;
  }

  /// Scatters light that arrives along wo (Bsdf::scatter); the direction of `light` is in world space.
  void scatter_light(RandomStream& rng, Scattered& light) const {
    bsdf_->scatter(wo_, rng, {&light, 1});
    if (!light.weight.is_black()) light.direction = frame_.to_world(light.direction);
  }

  /// Estimates the directional albedo by the mean weight of `samples` samples. Their numbers are an additive recurrence
  /// with a random start, which spreads them evenly (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom
  /// Sequences"). They are independent of the path's own numbers, so that the noise of the albedo is not correlated
  /// with the noise of the colours.
  SampledSpectrum albedo(int samples, uint64_t key) const {
    RandomStream start(key);
    const float uc = start.uniform();
    const Vec2 u{start.uniform(), start.uniform()};
    SampledSpectrum sum;
    for (int i = 0; i < samples; ++i) {
      const auto moved = [i](float from, float step) {
        const float to = from + float(i) * step;
        return std::min(to - std::floor(to), 0x1.fffffep-1f);
      };
      Sample sample;
      const bool scattered = this->sample(moved(uc, 0.81917251f), {moved(u.x, 0.67104361f), moved(u.y, 0.54970048f)},
                                          RandomStream(hash_key(key, uint64_t(i))), sample);
      if (scattered && sample.weight.is_physical()) sum += sample.weight;
    }
    return sum * (1 / float(samples));
  }

 private:
  const Bsdf* bsdf_ = nullptr;
  Frame frame_;
  Vec3 wo_;
};

}  // namespace frond
