#pragma once

#include "core/bssrdf.h"
#include "core/math/affine_map.h"
#include "core/math/sampling.h"
#include "materials/lobes/beam_diffusion.h"
#include "materials/lobes/fresnel.h"

namespace frond {

/// Light that leaves a medium through its interface, or enters it, diffusely: the transmission of the interface over
/// its mean, so that the integral with the cosine is n^2 (core/bssrdf.h; "Sw" of pbrt 4th ed.).
class InterfaceExitBsdf final : public Bsdf {
 public:
  /// `eta`: index of refraction of the medium over that outside; `transmitted`: diffuse transmittance from outside.
  /// Lanes where `mask` is 0 stay black.
  InterfaceExitBsdf(float eta, float transmitted, const SampledSpectrum& mask)
      : eta_(eta), most_(mask * (eta * eta / transmitted)) {}

  Lobes flags() const override { return Lobes::diffuse | Lobes::reflection; }
  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    if (!same_side(wo, wi)) return {};
    return most_ * (kInvPi * (1 - fresnel_dielectric(std::abs(wi.z), eta_)));
  }
  float pdf(const Vec3& wo, const Vec3& wi) const override { return same_side(wo, wi) ? std::abs(wi.z) * kInvPi : 0; }
  std::optional<BsdfSample> sample(const Vec3& wo, float, Vec2 u, RandomStream& rng) const override {
    Vec3 wi = sample_cosine_hemisphere(u);
    if (wo.z < 0) wi.z = -wi.z;
    const float density = pdf(wo, wi);
    if (density == 0) return {};
    return BsdfSample{.f = f(wo, wi, rng), .wi = wi, .pdf = density, .flags = flags(), .eta = 1 / eta_};
  }

 private:
  float eta_;
  SampledSpectrum most_;
};

/// BSSRDF of a homogeneous medium with the profile of photon beam diffusion (pbrt 4th ed.). Segments are parallel to
/// the normal or to one of two tangents, at a distance that is sampled from the profile of one lane.
class TabulatedBssrdf final : public Bssrdf {
 public:
  /// `sigma_t`: extinction coefficient, 1/unit; `albedo`: single-scattering albedo.
  TabulatedBssrdf(const BeamDiffusion& table, const Hit& po, const SampledSpectrum& sigma_t,
                  const SampledSpectrum& albedo, const SampledWavelengths& lambda, const InterfaceExitBsdf& exit)
      : table_(table), p_(po.p), frame_(po.shading), albedo_(albedo), exit_(exit) {
    const float most = 1 / (kLeastPath * largest_coordinate(p_) + 1e-15f);
    for (int lane = 0; lane < kLanes; ++lane) {
      sigma_t_[lane] = std::min(sigma_t[lane], most);
      if (lambda.is_active(lane) && sigma_t[lane] > kLeastExtinction && albedo[lane] > 0)
        lanes_[size_t(count_++)] = lane;
    }
  }

  std::optional<Segment> sample(float uc, Vec2 u) const override {
    if (count_ == 0) return {};
    const float place = uc * float(count_);
    const int chosen = std::min(int(place), count_ - 1);
    const int lane = lanes_[size_t(chosen)];
    const BeamProfile profile(table_, albedo_[lane]);
    const float r = profile.radius(u.x) / sigma_t_[lane], farthest = profile.farthest() / sigma_t_[lane];
    if (!(r < farthest && farthest < INFINITY)) return {};
    const size_t axis = axis_of(place - float(chosen));
    const Vec3 axes[] = {frame_.x, frame_.y, frame_.z};
    const Vec2 at = on_circle(u.y) * r;
    const Vec3 middle = p_ + axes[(axis + 1) % 3] * at.x + axes[(axis + 2) % 3] * at.y;
    const Vec3 half = axes[axis] * std::sqrt(std::max(0.f, farthest * farthest - r * r));
    return Segment{middle - half, middle + half};
  }

  /// A lane whose segments end before the point has no part in its density.
  SampledSpectrum weight(const Hit& pi) const override {
    const Vec3 d = frame_.to_local(pi.p - p_), n = frame_.to_local(pi.ng);
    const float distance = length(d);
    const Vec3 d2{d.x * d.x, d.y * d.y, d.z * d.z};
    const float across[] = {std::sqrt(d2.y + d2.z), std::sqrt(d2.z + d2.x), std::sqrt(d2.x + d2.y)};
    SampledSpectrum value;
    float density = 0;
    for (int i = 0; i < count_; ++i) {
      const int lane = lanes_[size_t(i)];
      const BeamProfile profile(table_, albedo_[lane]);
      const float sigma = sigma_t_[lane];
      value[lane] = profile.at(distance * sigma) * (sigma * sigma);
      if (!(distance * sigma <= profile.farthest() && profile.reflectance() > 0)) continue;
      float sum = 0;
      for (size_t axis = 0; axis < 3; ++axis)
        sum += kAxes[axis] * std::abs(n[int(axis)]) * profile.at(across[axis] * sigma);
      density += sum * (sigma * sigma) / profile.reflectance();
    }
    return density > 0 ? value * (float(count_) / density) : SampledSpectrum();
  }

  const Bsdf& exit() const override { return exit_; }

 private:
  /// Shorter mean free paths, relative to the coordinates of the point, are lengthened to this: floats do not resolve
  /// points that are closer (15 um at 1 m).
  static constexpr float kLeastPath = 0x1p-16f;
  /// Extinction coefficient below which no body scatters.
  static constexpr float kLeastExtinction = 1e-12f;
  /// Probabilities of segments parallel to x, y and z.
  static constexpr float kAxes[] = {0.25f, 0.25f, 0.5f};
  static size_t axis_of(float u) { return u < kAxes[0] ? 0 : u < kAxes[0] + kAxes[1] ? 1 : 2; }

  /// Point of the unit circle, for u in [0, 1).
  static Vec2 on_circle(float u) {
    const int quarter = std::min(int(4 * u), 3);
    const SineCosine a((4 * u - float(quarter) - 0.5f) * (kPi / 2));
    const Vec2 points[] = {{a.cosine, a.sine}, {-a.sine, a.cosine}, {-a.cosine, -a.sine}, {a.sine, -a.cosine}};
    return points[quarter];
  }

  const BeamDiffusion& table_;
  Vec3 p_;
  Frame frame_;
  SampledSpectrum sigma_t_, albedo_;
  InterfaceExitBsdf exit_;
  std::array<int, kLanes> lanes_{};  ///< active lanes that scatter
  int count_ = 0;
};

}  // namespace frond
