#pragma once

#include <limits>

#include "core/bsdf.h"
#include "core/math/sampling.h"
#include "leaf/table/lookup.h"
#include "leaf/table/reciprocal_lookup.h"
#include "materials/lobes/incident.h"
#include "materials/lobes/surface_lobe.h"

namespace frond {

/// Data of a ThreeLobeBsdf: a leaf at a hit, at the wavelengths of the path. Objects pointed to must outlive the BSDF.
struct LeafHit {
  const leaf::TableLookup* table;
  const leaf::TableSelection* selection;  ///< the table's columns for this hit
  const leaf::Lobe* surface;
  SampledSpectrum active;                              ///< 1 in active lanes, 0 elsewhere
  const leaf::ReciprocalLookup* reciprocal = nullptr;  ///< of a reciprocal leaf
  leaf::ReciprocalLookup::Position exponent = {};      ///< likewise: position of the surface lobe's exponent
};

/// Options of a ThreeLobeBsdf.
struct LeafManner {
  /// False: `f` and `pdf` omit the surface lobe, and `sample` returns it as a delta lobe, which excludes it from light
  /// sampling.
  bool surface_direct = true;
  Incident incident = Incident::traced;
};

/// A leaf as three lobes, each scaled by its share of the light (Baranoski and Rokne): a power of the cosine about the
/// mirror direction (Rs), a cosine lobe on the side of incidence (Rd) and one on the other side (T).
class ThreeLobeBsdf final : public Bsdf {
 public:
  ThreeLobeBsdf(const LeafHit& hit, const LeafManner& manner) : hit_(hit), manner_(manner), surface_(hit.surface) {}

  Lobes flags() const override {
    const Lobes surface = Lobes::surface | (manner_.surface_direct ? Lobes::glossy : Lobes::glossy | Lobes::specular);
    return Lobes::reflection | Lobes::transmission | Lobes::diffuse | surface | incident_flag();
  }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    return leaf_scatters(wo, wi) ? leaf_f(wo, wi, lobe_density(wo, wi)) : SampledSpectrum();
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float, Vec2 u, RandomStream& rng) const override {
    if (std::abs(wo.z) < kLeastCosine) return {};
    const Choice& choice = choice_at(wo);
    const float diffuse = choice.surface + choice.subsurface;
    if (u.x < choice.surface) return sample_surface(choice, wo, {remap_sample(u.x, 0, choice.surface), u.y}, rng);
    const bool reflects = u.x < diffuse;
    u.x = reflects ? remap_sample(u.x, choice.surface, diffuse) : remap_sample(u.x, diffuse, 1);
    Vec3 wi = sample_cosine_hemisphere(u);
    if ((wo.z < 0) == reflects) wi.z = -wi.z;
    if (std::abs(wi.z) < kLeastCosine) return {};
    if (reflects) return reflected(wo, wi, Lobes::reflection | Lobes::diffuse);
    const float density = choice.transmitted * std::abs(wi.z) * kInvPi;
    if (density == 0) return {};  // black
    return make_sample(leaf_f(wo, wi, 0), wi, density, Lobes::transmission | Lobes::diffuse);
  }

  float pdf(const Vec3& wo, const Vec3& wi) const override {
    return leaf_scatters(wo, wi) ? leaf_pdf(wo, wi, lobe_density(wo, wi)) : 0;
  }

  /// Scatters light along the model's own incident direction, whichever direction paths use.
  void scatter(const Vec3& incident, RandomStream& rng, std::span<Scattered> rays) const override {
    LeafManner manner = manner_;
    if (from_light()) manner.incident = Incident::traced;
    ThreeLobeBsdf(hit_, manner).Bsdf::scatter(incident, rng, rays);
  }

 private:
  /// Probabilities of the lobes for one wo.
  struct Choice {
    float cos_theta = std::numeric_limits<float>::quiet_NaN();
    float surface, subsurface, transmitted;
  };

  /// Terms that depend on the incident direction alone.
  struct Incidence {
    float cos_theta = std::numeric_limits<float>::quiet_NaN();
    leaf::SampledShares shares;  ///< 0 in lanes that are not active
  };
  /// Terms of a reciprocal leaf for one of the two directions.
  struct Mutual {
    float cos_theta = std::numeric_limits<float>::quiet_NaN();
    leaf::SampledShares shares;
    leaf::ReciprocalLookup::Factors factors;  ///< 0 in lanes that are not active
  };

  static float sum(const SampledSpectrum& s) { return (s[0] + s[1]) + (s[2] + s[3]); }

  bool from_light() const { return manner_.incident == Incident::light; }
  bool is_reciprocal() const { return manner_.incident == Incident::reciprocal; }
  Lobes incident_flag() const { return from_light() ? Lobes::from_light : Lobes::none; }

  /// Cached, since f, pdf and sample are called in turn for one direction.
  const leaf::SampledShares& shares_at(float cos_theta) const {
    if (incidence_.cos_theta == cos_theta) return incidence_.shares;
    incidence_.cos_theta = cos_theta;
    leaf::SampledShares& shares = incidence_.shares;
    shares = (*hit_.table)(cos_theta, *hit_.selection);
    shares.surface *= hit_.active;
    shares.subsurface *= hit_.active;
    shares.transmitted *= hit_.active;
    return shares;
  }

  const Choice& choice_at(const Vec3& wo) const {
    if (choice_.cos_theta == wo.z) return choice_;
    choice_.cos_theta = wo.z;
    float surface = sum(shares_at(wo.z).surface), subsurface, transmitted;
    if (is_reciprocal()) {
      subsurface = sum(hit_.active * mutual_of(wo).factors.back);
      transmitted = sum(shares_at(wo.z).subsurface) + sum(shares_at(wo.z).transmitted) - subsurface;
      transmitted = std::max(transmitted, 0.f);
    } else if (from_light()) {
      // The incident direction is not known yet: shares at the mean cosine over a hemisphere, on either side.
      constexpr float kMeanCosine = 2.f / 3;
      const float mean = wo.z > 0 ? kMeanCosine : -kMeanCosine;
      subsurface = sum(shares_at(mean).subsurface);
      transmitted = sum(shares_at(-mean).transmitted);
    } else {
      subsurface = sum(shares_at(wo.z).subsurface);
      transmitted = sum(shares_at(wo.z).transmitted);
    }
    const float all = surface + subsurface + transmitted, norm = all > 0 ? 1 / all : 0;
    choice_.surface = surface * norm;
    choice_.subsurface = subsurface * norm;
    choice_.transmitted = transmitted * norm;
    return choice_;
  }

  /// Value of the surface lobe; 0 if `f` omits it.
  float lobe_density(const Vec3& wo, const Vec3& wi) const {
    return manner_.surface_direct ? surface_.lobe_density(wo, wi) : 0;
  }

  Mutual mutual_at(float cos_theta) const {
    Mutual m{cos_theta, (*hit_.table)(cos_theta, *hit_.selection),
             (*hit_.reciprocal)(cos_theta, hit_.exponent, *hit_.selection)};
    m.factors.surface *= hit_.active;
    m.factors.subsurface *= hit_.active;
    return m;
  }
  const Mutual& mutual_of(const Vec3& wo) const {
    if (mutual_.cos_theta != wo.z) mutual_ = mutual_at(wo.z);
    return mutual_;
  }

  SampledSpectrum reciprocal_f(const Vec3& wo, const Vec3& wi, float lobe) const {
    const Mutual &a = mutual_of(wo), b = mutual_at(wi.z);
    const SampledSpectrum both = a.factors.subsurface * b.factors.subsurface * (kInvPi / 2);
    if (!same_side(wo, wi)) return both * (a.shares.transmitted + b.shares.transmitted);
    const SampledSpectrum subsurface = both * (a.shares.subsurface + b.shares.subsurface);
    return lobe == 0 ? subsurface : subsurface + a.factors.surface * b.factors.surface * lobe;
  }

  SampledSpectrum leaf_f(const Vec3& wo, const Vec3& wi, float lobe) const {
    if (is_reciprocal()) return reciprocal_f(wo, wi, lobe);
    const Vec3 &incident = from_light() ? wi : wo, &leaving = from_light() ? wo : wi;
    const leaf::SampledShares& shares = shares_at(incident.z);
    if (!same_side(wo, wi)) return shares.transmitted * kInvPi;
    const SampledSpectrum subsurface = shares.subsurface * kInvPi;
    if (lobe == 0) return subsurface;
    return subsurface + shares.surface * (lobe * surface_.normalisation(incident.z) / std::abs(leaving.z));
  }

  float leaf_pdf(const Vec3& wo, const Vec3& wi, float lobe) const {
    const Choice& choice = choice_at(wo);
    const float cosine = std::abs(wi.z) * kInvPi;
    if (!same_side(wo, wi)) return choice.transmitted * cosine;
    const float subsurface = choice.subsurface * cosine;
    return lobe == 0 ? subsurface : subsurface + choice.surface * lobe * surface_.normalisation(wo.z);
  }

  /// Completes a sample on wo's side; nothing if f is black.
  std::optional<BsdfSample> reflected(const Vec3& wo, Vec3 wi, Lobes from) const {
    const float lobe = lobe_density(wo, wi), density = leaf_pdf(wo, wi, lobe);
    return density == 0 ? std::nullopt : make_sample(leaf_f(wo, wi, lobe), wi, density, from);
  }

  /// Constructed in place: a copy would wait for the stores of its parts.
  static std::optional<BsdfSample> make_sample(const SampledSpectrum& f, Vec3 wi, float density, Lobes from) {
    std::optional<BsdfSample> result;
    BsdfSample& sample = result.emplace();
    sample.f = f;
    sample.wi = wi;
    sample.pdf = density;
    sample.flags = from;
    return result;
  }

  std::optional<BsdfSample> sample_surface(const Choice& choice, const Vec3& wo, Vec2 u, RandomStream& rng) const {
    constexpr Lobes kLobe = Lobes::reflection | Lobes::glossy | Lobes::surface;
    const Vec3 wi = surface_.sample(wo, u, rng);
    if (!manner_.surface_direct) return BsdfSample{as_delta(wo, wi), wi, choice.surface, kLobe | Lobes::specular};
    return reflected(wo, wi, kLobe);
  }

  /// f of the surface lobe if wi, drawn from it, is treated as the only direction of a delta lobe.
  SampledSpectrum as_delta(const Vec3& wo, const Vec3& wi) const {
    const float drawn = surface_.normalisation(wo.z);
    if (is_reciprocal()) return mutual_of(wo).factors.surface * mutual_at(wi.z).factors.surface * (1 / drawn);
    if (!from_light()) return shares_at(wo.z).surface * (1 / std::abs(wi.z));
    return shares_at(wi.z).surface * (surface_.normalisation(wi.z) / (drawn * std::abs(wo.z)));
  }

  LeafHit hit_;
  LeafManner manner_;
  SurfaceLobe surface_;
  mutable Incidence incidence_;
  mutable Mutual mutual_;
  mutable Choice choice_;
};

}  // namespace frond
