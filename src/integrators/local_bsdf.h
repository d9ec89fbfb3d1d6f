#pragma once

#include <cmath>

#include "core/bsdf.h"
#include "core/material.h"

namespace frond {

/// A BSDF at a hit, in world space. The shading normal alone decides on which side a direction is, as in pbrt-v4 and
/// Mitsuba: the BSDF keeps all of its energy, however far that normal is from the geometric one.
class LocalBsdf {
 public:
  /// Set, not made anew: a copy of what has just been written field by field waits for all of it.
  void set(const Bsdf& bsdf, const Hit& hit, const Vec3& wo) {
    bsdf_ = &bsdf;
    frame_ = hit.shading;
    wo_ = frame_.to_local(wo);
  }

  SampledSpectrum f_cos(const Vec3& wi_world, RandomStream rng, float& pdf) const {
    const Vec3 wi = frame_.to_local(wi_world);
    pdf = bsdf_->pdf(wo_, wi);
    return pdf > 0 ? bsdf_->f(wo_, wi, rng) * std::abs(wi.z) : SampledSpectrum();
  }

  struct Sample {
    Vec3 wi;                 ///< world space
    SampledSpectrum weight;  ///< f |cos theta_i| / pdf
    float pdf;               ///< for the balance with light sampling
    float power_factor;      ///< by which refraction has divided the weight
    bool is_specular;
  };
  /// False where nothing is scattered.
  bool sample(float uc, Vec2 u, RandomStream rng, Sample& sample) const {
    const auto s = bsdf_->sample(wo_, uc, u, rng);
    if (!s) return false;
    sample.wi = frame_.to_world(s->wi);
    sample.weight = s->f * (std::abs(s->wi.z) / s->pdf);
    sample.pdf = s->pdf_is_approximate ? bsdf_->pdf(wo_, s->wi) : s->pdf;
    sample.power_factor = s->eta * s->eta;
    sample.is_specular = any(s->flags & Lobes::specular);
    return true;
  }

 private:
  const Bsdf* bsdf_ = nullptr;
  Frame frame_;
  Vec3 wo_;
};

}  // namespace frond
