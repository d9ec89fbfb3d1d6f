#pragma once

#include "core/bsdf.h"
#include "materials/lobes/active_lanes.h"
#include "materials/lobes/dielectric_interface.h"

namespace frond {

/// Index of refraction below a surface over that above, for the lanes of a path, clamped to [1e-3, 1e3].
class LaneIndices {
 public:
  LaneIndices(const SampledSpectrum& eta, const SampledWavelengths& lambda) {
    for (int lane = 0; lane < kLanes; ++lane) {
      eta_[lane] = 1;
      if (!lambda.active[size_t(lane)]) continue;
      // 0 is no index of refraction; pbrt-v4 takes 1 for it too.
      eta_[lane] = eta[lane] == 0 ? 1 : std::clamp(eta[lane], kLeast, 1 / kLeast);
      mask_[lane] = 1;
      if (lane == lambda.hero) hero_ = count_;
      lanes_[size_t(count_++)] = lane;
    }
    for (int i = 1; i < count_; ++i) disperses_ = disperses_ || index(i) != index(0);
  }

  /// Whether lanes differ.
  bool disperses() const { return disperses_; }
  /// The i-th active lane, and the number of active lanes.
  int lane(int i) const { return lanes_[size_t(i)]; }
  int count() const { return count_; }
  /// Lane that continues where lanes part; each of `among` lanes has the same probability.
  struct Continuing {
    int i, among;
  };
  /// Chooses among the active lanes whose `share` is positive (one at least): the hero, or one drawn uniformly if it is
  /// not set or not among them.
  Continuing choose_lane(const SampledSpectrum& share, RandomStream& rng) const {
    std::array<int, kLanes> lit{};
    int among = 0;
    for (int i = 0; i < count_; ++i)
      if (share[lane(i)] > 0) lit[size_t(among++)] = i;
    if (hero_ >= 0 && share[lane(hero_)] > 0) return {hero_, among};
    return {lit[size_t(std::min(int(rng.uniform() * float(among)), among - 1))], among};
  }
  /// Index of the i-th active lane.
  float index(int i) const { return eta_[lane(i)]; }
  const SampledSpectrum& eta() const { return eta_; }
  /// 1 in active lanes, 0 elsewhere.
  const SampledSpectrum& mask() const { return mask_; }
  /// Whether all indices are so close to 1 that no light is refracted.
  bool are_all_one() const {
    for (int i = 0; i < count_; ++i)
      if (std::abs(index(i) - 1) >= kAlmostOne) return false;
    return true;
  }
  /// Moves indices away from 1: closer to it, reflection and refraction by rough facets cannot be computed in float.
  void move_off_one() {
    for (int i = 0; i < count_; ++i)
      if (float& eta = eta_[lane(i)]; std::abs(eta - 1) < kAlmostOne) eta = eta < 1 ? 1 - kAlmostOne : 1 + kAlmostOne;
  }

 private:
  static constexpr float kLeast = 1e-3f, kAlmostOne = 1e-3f;

  SampledSpectrum eta_, mask_;
  std::array<int, kLanes> lanes_{};
  int count_ = 0, hero_ = -1;
  bool disperses_ = false;
};

/// Rough interface of a dielectric (Walter et al. 2007). If lanes are refracted by different angles, directions are
/// drawn for one lane at random, and the density is the mean over lanes.
class RoughDielectricBsdf final : public Bsdf {
 public:
  RoughDielectricBsdf(const TrowbridgeReitz& facets, LaneIndices indices) : facets_(facets), indices_(indices) {
    indices_.move_off_one();
  }

  Lobes flags() const override { return Lobes::glossy | Lobes::reflection | Lobes::transmission; }
  SampledSpectrum index_ratio() const override { return indices_.eta(); }
  const Bsdf* regularized(Arena& arena) const override {
    return arena.make<RoughDielectricBsdf>(facets_.regularized(), indices_);
  }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    const bool reflects = same_side(wo, wi);
    SampledSpectrum f;
    for (int i = 0; i < interface_count(); ++i) {
      const auto pair = lane_interface(i).pair(wo, wi);
      f[indices_.lane(i)] = pair.f * pair.share(reflects);
    }
    return indices_.disperses() || indices_.count() == 0 ? f : indices_.mask() * f[indices_.lane(0)];
  }

  float pdf(const Vec3& wo, const Vec3& wi) const override {
    const bool reflects = same_side(wo, wi);
    float sum = 0;
    for (int i = 0; i < interface_count(); ++i) {
      const auto pair = lane_interface(i).pair(wo, wi);
      sum += pair.pdf * pair.share(reflects);
    }
    return interface_count() > 0 ? sum / float(interface_count()) : 0;
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    if (is_grazing(wo) || interface_count() == 0) return {};
    const float place = uc * float(interface_count());
    const int chosen = std::min(int(place), interface_count() - 1);
    const DielectricInterface one = lane_interface(chosen);
    const Vec3 m = one.facet(wo, u);
    const bool reflects = place - float(chosen) < one.fresnel(wo, m);
    const auto way = reflects ? one.reflect(wo, m) : one.refract(wo, m);
    if (!way) return {};
    const float density = pdf(wo, way->wi);
    if (!(density > 0)) return {};
    return BsdfSample{.f = f(wo, way->wi, rng),
                      .wi = way->wi,
                      .pdf = density,
                      .flags = Lobes::glossy | (reflects ? Lobes::reflection : Lobes::transmission),
                      .eta = reflects ? 1 : one.eta_beyond(wo)};
  }

 private:
  /// Number of interfaces: one for all lanes, or one for each.
  int interface_count() const { return indices_.disperses() ? indices_.count() : std::min(indices_.count(), 1); }
  DielectricInterface lane_interface(int i) const { return {facets_, indices_.index(i)}; }

  TrowbridgeReitz facets_;
  LaneIndices indices_;
};

/// Smooth interface of a dielectric (Fresnel 1823). Reflection keeps all lanes; if lanes are refracted by different
/// angles, one of them continues.
class SmoothDielectricBsdf final : public Bsdf {
 public:
  explicit SmoothDielectricBsdf(const LaneIndices& indices) : indices_(indices) {}

  Lobes flags() const override {
    const Lobes flags = Lobes::specular | Lobes::reflection | Lobes::transmission;
    return indices_.disperses() ? flags | Lobes::stochastic : flags;
  }
  SampledSpectrum f(const Vec3&, const Vec3&, RandomStream&) const override { return {}; }
  float pdf(const Vec3&, const Vec3&) const override { return 0; }
  SampledSpectrum index_ratio() const override { return indices_.eta(); }
  /// Facets of index 1 would have no effect.
  const Bsdf* regularized(Arena& arena) const override {
    if (indices_.are_all_one()) return this;
    return arena.make<RoughDielectricBsdf>(TrowbridgeReitz(0, 0).regularized(), indices_);
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2, RandomStream& rng) const override {
    if (is_grazing(wo) || indices_.count() == 0) return {};
    const float cosine = std::abs(wo.z);
    SampledSpectrum share;
    float sum = 0;
    for (int i = 0; i < indices_.count(); ++i) {
      const float eta = wo.z > 0 ? indices_.index(i) : 1 / indices_.index(i);
      share[indices_.lane(i)] = fresnel_dielectric(cosine, eta);
      sum += share[indices_.lane(i)];
    }
    const float reflect = std::min(1.f, sum / float(indices_.count()));
    if (uc < reflect)
      return BsdfSample{share * (1 / cosine), {-wo.x, -wo.y, wo.z}, reflect, Lobes::specular | Lobes::reflection};
    return indices_.disperses() ? refract_one(wo, share, 1 - reflect, rng) : refract_all(wo, 1 - reflect);
  }

 private:
  /// All lanes have one index and one direction.
  std::optional<BsdfSample> refract_all(const Vec3& wo, float chance) const {
    const DielectricInterface border({0, 0}, indices_.index(0));
    const auto way = border.refract(wo, {0, 0, 1});
    if (!way) return {};
    return BsdfSample{.f = indices_.mask() * (way->weight / std::abs(way->wi.z)),
                      .wi = way->wi,
                      .pdf = chance,
                      .flags = Lobes::specular | Lobes::transmission,
                      .eta = border.eta_beyond(wo)};
  }

  /// One lane continues, none that is totally reflected; the sample is black in the other lanes.
  std::optional<BsdfSample> refract_one(const Vec3& wo, const SampledSpectrum& reflected, float chance,
                                        RandomStream& rng) const {
    const auto [chosen, among] = indices_.choose_lane(SampledSpectrum(indices_.mask().v - reflected.v), rng);
    const DielectricInterface border({0, 0}, indices_.index(chosen));
    const auto way = border.refract(wo, {0, 0, 1});
    if (!way) return {};
    BsdfSample s{.f = {},
                 .wi = way->wi,
                 .pdf = chance / float(among),
                 .flags = Lobes::specular | Lobes::transmission | Lobes::stochastic,
                 .eta = border.eta_beyond(wo)};
    s.f[indices_.lane(chosen)] = way->weight / std::abs(way->wi.z);
    return s;
  }

  LaneIndices indices_;
};

/// A pane without thickness: specular reflection and transmission, summed over all interreflections of its two faces
/// (geometric series); not refracted.
class ThinDielectricBsdf final : public Bsdf {
 public:
  explicit ThinDielectricBsdf(const LaneIndices& indices) : indices_(indices) {}

  Lobes flags() const override { return Lobes::specular | Lobes::reflection | Lobes::transmission; }
  SampledSpectrum f(const Vec3&, const Vec3&, RandomStream&) const override { return {}; }
  float pdf(const Vec3&, const Vec3&) const override { return 0; }

  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2, RandomStream&) const override {
    if (is_grazing(wo) || indices_.count() == 0) return {};
    const float cosine = std::abs(wo.z);
    SampledSpectrum reflected, transmitted;
    float sum = 0;
    for (int i = 0; i < indices_.count(); ++i) {
      const float one_face = fresnel_dielectric(cosine, indices_.index(i)), both = 2 * one_face / (1 + one_face);
      reflected[indices_.lane(i)] = both;
      transmitted[indices_.lane(i)] = 1 - both;
      sum += both;
    }
    const float reflect = std::min(1.f, sum / float(indices_.count()));
    const bool reflects = uc < reflect;
    return BsdfSample{.f = (reflects ? reflected : transmitted) * (1 / cosine),
                      .wi = reflects ? Vec3{-wo.x, -wo.y, wo.z} : -wo,
                      .pdf = reflects ? reflect : 1 - reflect,
                      .flags = Lobes::specular | (reflects ? Lobes::reflection : Lobes::transmission)};
  }

 private:
  LaneIndices indices_;
};

}  // namespace frond
