#pragma once

#include "core/phase.h"
#include "materials/lobes/conductor.h"
#include "materials/lobes/dielectric.h"

namespace frond {

/// The medium between a coat and its base. The extinction coefficient is 1, so `thickness` is an optical thickness.
struct CoatMedium {
  float thickness;
  SampledSpectrum albedo;  ///< single-scattering albedo; 0: the medium only absorbs
  float g;                 ///< mean cosine of scattering (Henyey and Greenstein 1941)
};

/// Limits of the walks between the layers.
struct LayerWalks {
  int max_depth;  ///< events below the coat, without the exit
  int samples;    ///< walks per call of f
};

/// Base of a LayeredBsdf: a Lambertian surface.
class DiffuseBase {
 public:
  explicit DiffuseBase(const SampledSpectrum& reflectance) : reflectance_(reflectance) {}

  static constexpr Lobes kLobe = Lobes::diffuse;
  bool is_smooth() const { return false; }
  DiffuseBase regularized() const { return *this; }
  SampledSpectrum f(const Vec3& wo, const Vec3& wi) const {
    return same_side(wo, wi) ? reflectance_ * kInvPi : SampledSpectrum();
  }
  float pdf(const Vec3& wo, const Vec3& wi) const { return same_side(wo, wi) ? std::abs(wi.z) * kInvPi : 0; }
  std::optional<BsdfSample> sample(const Vec3& wo, Vec2 u) const {
    const Vec3 wi = sample_cosine_hemisphere(u);
    if (is_grazing(wi)) return {};
    return BsdfSample{f(wo, wi), wi, pdf(wo, wi), Lobes::reflection | Lobes::diffuse};
  }
  /// Facets whose reflection approximates the base's lobe seen through the coat; none for a diffuse base.
  std::optional<TrowbridgeReitz> reflection_through_coat(const TrowbridgeReitz&, float) const { return {}; }

 private:
  SampledSpectrum reflectance_;
};

/// Base of a LayeredBsdf: a metal.
class ConductorBase {
 public:
  ConductorBase(const TrowbridgeReitz& facets, const ConductorIndices& indices, const SampledSpectrum& mask)
      : facets_(facets), metal_(facets, indices, mask) {}

  static constexpr Lobes kLobe = Lobes::glossy;
  bool is_smooth() const { return metal_.is_smooth(); }
  ConductorBase regularized() const { return {facets_.regularized(), metal_.regularized()}; }
  SampledSpectrum f(const Vec3& wo, const Vec3& wi) const { return metal_.f(wo, wi); }
  float pdf(const Vec3& wo, const Vec3& wi) const { return metal_.pdf(wo, wi); }
  std::optional<BsdfSample> sample(const Vec3& wo, Vec2 u) const { return metal_.sample(wo, u); }
  /// As above. Width of the lobe for light near the normal: twice the metal's slope, times eta outside; the coat's
  /// slope times eta - 1, on entry and on exit.
  std::optional<TrowbridgeReitz> reflection_through_coat(const TrowbridgeReitz& coat, float eta) const {
    if (coat.is_smooth() && is_smooth()) return {};
    const auto width = [&](float own, float above) {
      return std::clamp(std::hypot(eta * own, (eta - 1) * above * 0.7f), 0.003f, 1.f);
    };
    return TrowbridgeReitz(width(facets_.alpha().x, coat.alpha().x), width(facets_.alpha().y, coat.alpha().y));
  }

 private:
  ConductorBase(const TrowbridgeReitz& facets, const ConductorBsdf& metal) : facets_(facets), metal_(metal) {}

  TrowbridgeReitz facets_;
  ConductorBsdf metal_;
};

/// A dielectric coat over a reflecting base with a medium in between, the same on both sides. f is estimated by
/// position-free random walks between the layers (Guo, Hasan and Zhao 2018), connected to both directions; at a vertex
/// both sampling techniques are combined by the power heuristic. If the coat's index varies over the lanes, each call
/// evaluates one lane alone.
template <class Base>
class LayeredBsdf final : public Bsdf {
 public:
  LayeredBsdf(const TrowbridgeReitz& coat, const LaneIndices& indices, const Base& base, const CoatMedium& medium,
              const LayerWalks& walks)
      : coat_(coat), indices_(indices), base_(base), medium_(medium), walks_(walks) {
    if (indices_.are_all_one()) coat_ = TrowbridgeReitz(0, 0);  // its facets turn no light
    if (!coat_.is_smooth()) indices_.move_off_one();
    medium_.thickness = std::max(medium_.thickness, 0.f);
    medium_.g = std::clamp(medium_.g, -0.99f, 0.99f);
  }

  Lobes flags() const override {
    Lobes flags = Lobes::reflection | Lobes::stochastic | Base::kLobe;
    if (coat_.is_smooth()) flags = flags | Lobes::specular;
    return flags | Lobes::glossy;
  }

  const Bsdf* regularized(Arena& arena) const override {
    return arena.make<LayeredBsdf>(coat_.regularized(), indices_, base_.regularized(), medium_, walks_);
  }

  SampledSpectrum f(const Vec3& wo_, const Vec3& wi_, RandomStream& rng) const override {
    if (!same_side(wo_, wi_) || is_grazing(wo_) || is_grazing(wi_) || indices_.count() == 0) return {};
    const Vec3 wo = wo_.z < 0 ? -wo_ : wo_, wi = wo_.z < 0 ? -wi_ : wi_;
    const Coat coat = draw_coat(rng);
    SampledSpectrum walked;
    for (int i = 0; i < walks_.samples; ++i) walked += walk_between(coat, wo, wi, rng);
    SampledSpectrum f = walked * (1 / float(walks_.samples));
    if (!coat_.is_smooth()) {
      const auto pair = coat.border.pair(wo, wi);
      f += coat.lanes * (pair.f * pair.fresnel);
    }
    return f;
  }

  std::optional<BsdfSample> sample(const Vec3& wo_, float uc, Vec2 u, RandomStream& rng) const override {
    if (is_grazing(wo_) || indices_.count() == 0) return {};
    const bool turned = wo_.z < 0;
    const Coat coat = draw_coat(rng);
    auto s = walk_out(coat, turned ? -wo_ : wo_, uc, u, rng);
    if (!s || is_grazing(s->wi)) return {};
    if (turned) s->wi = -s->wi;
    // The weight f |cos| / pdf is exact for any pdf > 0; `pdf` is the approximate density of light sampling.
    s->pdf = any(s->flags & Lobes::specular) ? 1 : pdf(wo_, s->wi);
    s->f *= s->pdf / std::abs(s->wi.z);
    s->pdf_is_approximate = true;
    if (!(s->pdf > 0)) return {};
    return s;
  }

  /// Approximate: a mixture of the coat's reflection, the base's lobe seen through the coat, and a cosine lobe for the
  /// rest.
  float pdf(const Vec3& wo_, const Vec3& wi_) const override {
    if (!same_side(wo_, wi_) || is_grazing(wo_) || is_grazing(wi_) || indices_.count() == 0) return 0;
    const Vec3 wo = wo_.z < 0 ? -wo_ : wo_, wi = wo_.z < 0 ? -wi_ : wi_;
    if (coat_.is_smooth() && base_.is_smooth() && medium_.albedo.is_black()) return 0;
    // Below 1: where the first lane is reflected totally, another may not be.
    const float reflected = std::min(fresnel_dielectric(wo.z, indices_.index(0)), 0.95f);
    float density = wi.z * kInvPi;
    if (const auto lobe = base_.reflection_through_coat(coat_, indices_.index(0)))
      density = std::lerp(density, density_folded(*lobe, wo, wi), kLobeShare);
    if (coat_.is_smooth()) return (1 - reflected) * density;
    return std::lerp(density, density_folded(coat_, wo, wi), std::max(reflected, 0.05f));
  }

 private:
  static constexpr float kLobeShare = 0.9f;

  /// The coat at one wavelength; `lanes`: 1 / probability in the lanes that it applies to, 0 elsewhere.
  struct Coat {
    DielectricInterface border;
    SampledSpectrum lanes;
  };
  /// One coat for all lanes, or the coat of one lane.
  Coat draw_coat(RandomStream& rng) const {
    if (!indices_.disperses()) return {{coat_, indices_.index(0)}, indices_.mask()};
    const int chosen = indices_.choose_lane(indices_.mask(), rng).i;
    Coat coat{{coat_, indices_.index(chosen)}, {}};
    coat.lanes[indices_.lane(chosen)] = float(indices_.count());
    return coat;
  }

  static Vec2 uniform_pair(RandomStream& rng) {
    const float x = rng.uniform(), y = rng.uniform();
    return {x, y};
  }
  /// Beer's law along w, by optical distance along the normal.
  float transmittance(float distance, const Vec3& w) const { return std::exp(-distance / std::abs(w.z)); }

  /// Density of directions reflected by facets visible from wo; directions below the surface are mirrored to above it.
  static float density_folded(const TrowbridgeReitz& facets, const Vec3& wo, const Vec3& wi) {
    const auto density = [&](const Vec3& w) {
      const Vec3 m = normalize_any(wo + w);
      return dot(wo, m) > 0 ? facets.density(m) : 0;
    };
    return (density(wi) + density({wi.x, wi.y, -wi.z})) * facets.g1_over_cosine(wo) / 4;
  }

  /// State of a walk: height z over the base, direction of travel w.
  struct Walk {
    float z;
    Vec3 w;
    SampledSpectrum weight;
  };

  /// Advances to the next event. Returns true for scattering in the medium, whose albedo the weight then includes.
  bool advance(Walk& at, RandomStream& rng) const {
    const float end = at.w.z > 0 ? medium_.thickness : 0, way = std::abs(end - at.z);
    if (medium_.albedo.is_black()) {
      at.weight *= transmittance(way, at.w);
    } else if (const float step = -std::log1p(-rng.uniform()) * std::abs(at.w.z); step < way) {
      at.z += at.w.z > 0 ? step : -step;
      at.weight *= medium_.albedo;
      return true;
    }
    at.z = end;
    return false;
  }

  /// Russian roulette of walks of small weight; returns false if the walk ends.
  static bool survives_roulette(Walk& at, int depth, RandomStream& rng) {
    constexpr int kSafe = 4;
    constexpr float kLittle = 0.25f;
    const float most = at.weight.max();
    if (depth < kSafe || most >= kLittle) return most > 0;
    if (rng.uniform() >= most) return false;
    at.weight *= 1 / most;
    return true;
  }

  /// Factors of specular reflection between smooth layers, for light that finally travels up along one direction.
  struct Mirrors {
    SampledSpectrum base;  ///< reflected once by the base and transmitted up to the coat
    SampledSpectrum both;  ///< reflected by the coat, then as `base`
  };
  Mirrors mirrors_along(const DielectricInterface& border, const Vec3& up) const {
    Mirrors m;
    const float across = transmittance(medium_.thickness, up);
    if (const auto s = base_.sample(up, {})) m.base = s->f * (std::abs(s->wi.z) / s->pdf * across);
    m.both = m.base * (border.fresnel(-up, {0, 0, 1}) * across);
    return m;
  }

  /// Light scattered in the medium that reaches direction `up` through specular reflections alone, which no sampled
  /// direction can hit: first down to the base, or first up to the coat. At most `events` further events.
  SampledSpectrum specular_connection(const Mirrors& between, const Walk& at, const Vec3& up, int events) const {
    constexpr float kNegligible = 1e-7f;
    const auto scattered = [&](const Vec3& w) { return henyey_greenstein(dot(at.w, w), medium_.g); };
    SampledSpectrum first_down = between.base * (scattered({up.x, up.y, -up.z}) * transmittance(at.z, up));
    SampledSpectrum first_up = between.both * (scattered(up) * transmittance(medium_.thickness - at.z, up));
    SampledSpectrum sum;
    for (; events > 0; events -= 2) {
      sum += first_down;
      if (events > 1) sum += first_up;
      first_down *= between.both;
      first_up *= between.both;
      if (std::max(first_down.max(), first_up.max()) <= kNegligible * sum.max()) break;
    }
    return sum;
  }

  /// Estimate of f for light that passes the base or the medium.
  SampledSpectrum walk_between(const Coat& coat, const Vec3& wo, const Vec3& wi, RandomStream& rng) const {
    const DielectricInterface& border = coat.border;
    const auto in = border.refract(wo, border.facet(wo, uniform_pair(rng)));
    const auto out = border.refract(wi, border.facet(wi, uniform_pair(rng)));
    if (!in || is_grazing(in->wi)) return {};
    // Rough facets may still be hit from below if this sample has no transmitted direction.
    const bool connects = out && !is_grazing(out->wi);
    if (!connects && coat_.is_smooth()) return {};
    const Vec3 up = connects ? -out->wi : Vec3{0, 0, 1};
    const float eta = border.eta_beyond(wi);
    const float out_weight = connects ? out->weight * eta * eta : 0;  // eta^2: used in the reverse direction
    const bool smooth = coat_.is_smooth();
    // MIS weight of the connection to wi through the coat, against a density `pdf` of sampling `up` elsewhere.
    const auto against = [&](float pdf) { return smooth || !connects ? 1 : power_heuristic(out->pdf, pdf); };
    // Light of a walk that goes up and leaves through the rough coat toward wi, with its MIS weight.
    const auto escaped = [&](const Walk& at, float pdf, bool is_delta) -> SampledSpectrum {
      if (smooth || !(at.w.z > 0)) return {};
      const auto pair = border.pair(-at.w, wi);
      if (pair.f == 0) return {};
      const float weight = is_delta ? 1 : power_heuristic(pdf, border.pair(wi, -at.w).pdf);
      return at.weight * (pair.f * (1 - pair.fresnel) * weight * transmittance(medium_.thickness - at.z, at.w));
    };

    const bool mirrors = smooth && base_.is_smooth();
    const Mirrors between = mirrors ? mirrors_along(border, up) : Mirrors{};

    SampledSpectrum sum;
    Walk at{medium_.thickness, in->wi, coat.lanes * in->weight};
    for (int depth = 0; depth < walks_.max_depth && survives_roulette(at, depth, rng); ++depth) {
      if (is_grazing(at.w)) break;
      if (advance(at, rng)) {
        const float p = henyey_greenstein(dot(at.w, up), medium_.g);
        sum += at.weight * (p * against(p) * transmittance(medium_.thickness - at.z, up) * out_weight / up.z);
        if (mirrors)
          sum += at.weight * specular_connection(between, at, up, walks_.max_depth - 1 - depth) * (out_weight / up.z);
        const Vec3 before = at.w;
        at.w = sample_henyey_greenstein(before, medium_.g, uniform_pair(rng));
        if (is_grazing(at.w)) break;
        sum += escaped(at, henyey_greenstein(dot(before, at.w), medium_.g), false);
      } else if (at.w.z > 0) {
        const auto back = border.reflect(-at.w, border.facet(-at.w, uniform_pair(rng)));
        if (!back) break;
        at.weight *= back->weight;
        at.w = back->wi;
      } else {
        if (!base_.is_smooth())
          sum += at.weight * base_.f(-at.w, up) *
                 (against(base_.pdf(-at.w, up)) * transmittance(medium_.thickness, up) * out_weight);
        const auto next = base_.sample(-at.w, uniform_pair(rng));
        if (!next || is_grazing(next->wi)) break;
        at.weight *= next->f * (std::abs(next->wi.z) / next->pdf);
        at.w = next->wi;
        sum += escaped(at, next->pdf, base_.is_smooth());
      }
    }
    return sum;
  }

  /// Walks from wo until the walk leaves; f holds its weight.
  std::optional<BsdfSample> walk_out(const Coat& coat, const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const {
    const DielectricInterface& border = coat.border;
    const Lobes coat_lobe = coat_.is_smooth() ? Lobes::specular : Lobes::glossy;
    const Vec3 m = border.facet(wo, u);
    const float reflected = border.fresnel(wo, m);
    if (uc < reflected) {
      const auto way = border.reflect(wo, m);
      if (!way) return {};
      return BsdfSample{.f = coat.lanes * (way->weight / reflected),
                        .wi = way->wi,
                        .flags = Lobes::reflection | Lobes::stochastic | coat_lobe};
    }
    const auto in = border.refract(wo, m);
    if (!in || is_grazing(in->wi)) return {};
    Walk at{medium_.thickness, in->wi, coat.lanes * (in->weight / (1 - reflected))};
    bool is_delta = coat_.is_smooth();
    for (int depth = 0; survives_roulette(at, depth, rng); ++depth) {
      if (is_grazing(at.w)) return {};
      const bool may_go_on = depth < walks_.max_depth;
      if (advance(at, rng)) {
        if (!may_go_on) return {};
        at.w = sample_henyey_greenstein(at.w, medium_.g, uniform_pair(rng));
        is_delta = false;
      } else if (at.w.z > 0) {
        const Vec3 inner = border.facet(-at.w, uniform_pair(rng));
        const float back = border.fresnel(-at.w, inner);
        const bool stays = rng.uniform() < back;
        const auto way = stays ? border.reflect(-at.w, inner) : border.refract(-at.w, inner);
        if (!way || (stays && !may_go_on)) return {};
        at.weight *= way->weight / (stays ? back : 1 - back);
        at.w = way->wi;
        if (!stays)
          return BsdfSample{
              .f = at.weight,
              .wi = at.w,
              .flags = Lobes::reflection | Lobes::stochastic | (is_delta ? Lobes::specular : Base::kLobe)};
      } else {
        if (!may_go_on) return {};
        const auto next = base_.sample(-at.w, uniform_pair(rng));
        if (!next) return {};
        at.weight *= next->f * (std::abs(next->wi.z) / next->pdf);
        at.w = next->wi;
        is_delta = is_delta && base_.is_smooth();
      }
    }
    return {};
  }

  TrowbridgeReitz coat_;
  LaneIndices indices_;
  Base base_;
  CoatMedium medium_;
  LayerWalks walks_;
};

}  // namespace frond
