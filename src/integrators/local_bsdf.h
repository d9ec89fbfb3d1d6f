#pragma once

#include <cmath>

#include "core/bsdf.h"
#include "core/material.h"

namespace frond {

/// A BSDF at a hit, in world space. The geometric normal decides the side: where the shading normal would put a
/// direction on the other one, nothing is scattered there.
class LocalBsdf {
 public:
  /// Set, not made anew: a copy of what has just been written field by field waits for all of it.
  void set(const Bsdf& bsdf, const Hit& hit, const Vec3& wo) {
    bsdf_ = &bsdf;
    ng_ = hit.ng;
    frame_ = hit.shading;
    // A shading normal that turns away from the viewer is bent back to the side that the ray met.
    if (dot(wo, frame_.z) * dot(wo, hit.ng) <= 0) frame_ = Frame::around(hit.ng);
    wo_ = frame_.to_local(wo);
  }

  SampledSpectrum f_cos(const Vec3& wi_world, RandomStream rng, float& pdf) const {
    const Vec3 wi = frame_.to_local(wi_world);
    if (!agrees(wi_world, wi)) return {};
    pdf = bsdf_->pdf(wo_, wi);
    return pdf > 0 ? bsdf_->f(wo_, wi, rng) * std::abs(wi.z) : SampledSpectrum();
  }

  struct Sample {
    Vec3 wi;                 ///< world space
    SampledSpectrum weight;  ///< f |cos theta_i| / pdf
    float pdf;               ///< for the balance with light sampling
    float radiance_factor;   ///< what refraction has done to the weight
    bool is_specular;
  };
  /// False where nothing is scattered.
  bool sample(float uc, Vec2 u, RandomStream rng, Sample& sample) const {
    const auto s = bsdf_->sample(wo_, uc, u, rng);
    if (!s) return false;
    sample.wi = frame_.to_world(s->wi);
    if (!agrees(sample.wi, s->wi)) return false;
    sample.weight = s->f * (std::abs(s->wi.z) / s->pdf);
    sample.pdf = s->pdf_is_approximate ? bsdf_->pdf(wo_, s->wi) : s->pdf;
    sample.radiance_factor = 1 / (s->eta * s->eta);
    sample.is_specular = any(s->flags & Lobes::specular);
    return true;
  }

 private:
  bool agrees(const Vec3& world, const Vec3& local) const { return local.z * dot(world, ng_) > 0; }

  const Bsdf* bsdf_ = nullptr;
  Vec3 ng_;
  Frame frame_;
  Vec3 wo_;
};

}  // namespace frond
