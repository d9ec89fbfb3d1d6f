#pragma once

#include <limits>

#include "core/bsdf.h"
#include "core/math/sampling.h"
#include "leaf/table/mode_lookup.h"
#include "leaf/table/surface_scaling.h"
#include "materials/lobes/incident.h"
#include "materials/lobes/surface_lobe.h"

namespace frond {

/// Data of a SolvedBsdf: a solved leaf at a hit, at the wavelengths of the path. Objects pointed to must outlive the
/// BSDF.
struct SolvedHit {
  const leaf::ModeLookup* table;
  const leaf::ModeLookup::Selection* selection;
  const leaf::Lobe* surface;
  SampledSpectrum active;  ///< 1 in active lanes, 0 elsewhere
  Incident incident;
  const leaf::SurfaceScaling* scaling = nullptr;  ///< of a reciprocal leaf, whose table is reciprocal too
  leaf::SurfaceScaling::Position exponent = {};   ///< likewise: position of the surface lobe's exponent
};

/// A leaf by the solution of its walk: the surface's lobe in closed form, and the light that has been inside by its
/// Fourier modes over azimuth. Directions are drawn from the surface's lobe and a cosine lobe on either side, in
/// proportion to the light in each.
class SolvedBsdf final : public Bsdf {
 public:
  explicit SolvedBsdf(const SolvedHit& hit) : hit_(hit), surface_(hit.surface) {}

  Lobes flags() const override {
    const Lobes way_round = from_light() ? Lobes::from_light : Lobes::none;
    return Lobes::reflection | Lobes::transmission | Lobes::diffuse | Lobes::glossy | Lobes::surface | way_round;
  }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    return leaf_scatters(wo, wi) ? SampledSpectrum(leaf_f(wo, wi, surface_.lobe_density(wo, wi))) : SampledSpectrum();
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float, Vec2 u, RandomStream& rng) const override {
    if (std::abs(wo.z) < kLeastCosine) return {};
    const Choice& choice = choice_at(wo);
    const float diffuse = choice.surface + choice.reflected;
    if (u.x < choice.surface) {
      u.x = remap_sample(u.x, 0, choice.surface);
      return sampled(wo, surface_.sample(wo, u, rng), Lobes::reflection | Lobes::glossy | Lobes::surface);
    }
    const bool reflects = u.x < diffuse;
    u.x = reflects ? remap_sample(u.x, choice.surface, diffuse) : remap_sample(u.x, diffuse, 1);
    Vec3 wi = sample_cosine_hemisphere(u);
    if ((wo.z < 0) == reflects) wi.z = -wi.z;
    if (std::abs(wi.z) < kLeastCosine) return {};
    return sampled(wo, wi, Lobes::diffuse | (reflects ? Lobes::reflection : Lobes::transmission));
  }

  float pdf(const Vec3& wo, const Vec3& wi) const override {
    return leaf_scatters(wo, wi) ? leaf_pdf(wo, wi, surface_.lobe_density(wo, wi)) : 0;
  }

  /// Scatters light along the model's own incident direction, whichever direction paths use.
  void scatter(const Vec3& incident, RandomStream& rng, std::span<Scattered> rays) const override {
    SolvedHit hit = hit_;
    if (from_light()) hit.incident = Incident::traced;
    SolvedBsdf(hit).Bsdf::scatter(incident, rng, rays);
  }

 private:
  bool from_light() const { return hit_.incident == Incident::light; }
  bool is_reciprocal() const { return hit_.incident == Incident::reciprocal; }

  /// Probabilities of the lobes for one wo.
  struct Choice {
    float cos_theta = std::numeric_limits<float>::quiet_NaN();
    float surface, reflected, transmitted;
  };

  /// Terms that depend on the incident direction alone.
  struct Incidence {
    Vec3 direction{std::numeric_limits<float>::quiet_NaN(), 0, 0};
    float sine;
    leaf::SineNodes nodes;
    Float4 reflectance;  ///< of the surface; 0 in lanes that are not active
    Float4 enters;       ///< 1 - reflectance, likewise
    Float4 surface;      ///< of a reciprocal leaf: scale of the surface's lobe for this direction
  };

  /// Transmission of the surface for a direction outside, never totally reflected.
  struct Passage {
    Float4 through;      ///< 1 - F, Fresnel
    Float4 over_cosine;  ///< the same over the cosine inside, mu'
  };

  static float sine2(const Vec3& w) { return std::min(w.x * w.x + w.y * w.y, 1.f); }

  /// With n cos theta' = q: (1 - F) = 2 q cos theta (1 / (cos theta + q)^2 + n^2 / (n^2 cos theta + q)^2).
  Passage passage(const Vec3& w) const {
    const float cosine = std::abs(w.z);
    const Float4 n = hit_.selection->index.v, n2 = n * n, q = square_root(n2 - sine2(w));
    const Float4 s = cosine + q, p = n2 * cosine + q, both = s * p;
    const Float4 part = 2 * cosine * (p * p + n2 * (s * s)) / (both * both);
    return {q * part, n * part};
  }

  /// Cached, since f, pdf and sample are called in turn for one direction.
  const Incidence& incidence_at(const Vec3& incident) const {
    if (incidence_.direction != incident) set(incidence_, incident);
    return incidence_;
  }

  void set(Incidence& in, const Vec3& incident) const {
    in.direction = incident;
    in.sine = std::sqrt(sine2(incident));
    in.nodes = hit_.table->nodes(in.sine);
    const Float4 active = hit_.active.v;
    in.enters = active * passage(incident).through;
    in.reflectance = active - in.enters;
    if (is_reciprocal())
      in.surface = in.reflectance / hit_.scaling->at(hit_.exponent, std::abs(incident.z), hit_.selection->index.v);
  }

  /// Each lobe keeps at least 1 % of the probability, so that no direction with f > 0 has density 0.
  const Choice& choice_at(const Vec3& wo) const {
    if (choice_.cos_theta == wo.z) return choice_;
    choice_.cos_theta = wo.z;
    const Incidence& in = incidence_at(wo);
    const auto ways = hit_.table->ways(wo.z < 0, in.nodes, in.enters, hit_.selection->columns);
    const float surface = sum(in.reflectance);
    float reflected = ways.back, transmitted = from_light() ? ways.across_to : ways.across;
    constexpr float kLeastPart = 0.01f;
    const float least = kLeastPart * (surface + reflected + transmitted);
    reflected = std::max(reflected, least);
    transmitted = std::max(transmitted, least);
    const float all = surface + reflected + transmitted, norm = all > 0 ? 1 / all : 0;
    choice_.surface = surface * norm;
    choice_.reflected = reflected * norm;
    choice_.transmitted = transmitted * norm;
    return choice_;
  }

  /// Completes a sample; nothing if f is black.
  std::optional<BsdfSample> sampled(const Vec3& wo, Vec3 wi, Lobes from) const {
    std::optional<BsdfSample> result;
    const float lobe = surface_.lobe_density(wo, wi), density = leaf_pdf(wo, wi, lobe);
    if (density == 0) return result;
    // Constructed in place: a copy would wait for the stores of its parts.
    BsdfSample& sample = result.emplace();
    sample.f = SampledSpectrum(leaf_f(wo, wi, lobe));
    sample.wi = wi;
    sample.pdf = density;
    sample.flags = from;
    return result;
  }

  /// Bitwise equal if the directions are exchanged.
  Float4 reciprocal_f(const Vec3& wo, const Vec3& wi, float lobe) const {
    const Incidence& a = incidence_at(wo);
    Incidence b;
    set(b, wi);
    const Float4 subsurface = a.enters * b.enters *
                              hit_.table->reciprocal_value({wo.z < 0, a.sine, a.nodes}, {wi.z < 0, b.sine, b.nodes},
                                                           cos_phi(wo, wi, a.sine * b.sine), hit_.selection->columns);
    return lobe == 0 ? subsurface : subsurface + a.surface * b.surface * lobe;
  }

  /// Cosine of the azimuth from straight ahead; `sines`: product of the two directions' sines.
  static float cos_phi(const Vec3& wo, const Vec3& wi, float sines) {
    return sines > 0 ? std::clamp(-(wo.x * wi.x + wo.y * wi.y) / sines, -1.f, 1.f) : 1;
  }

  Float4 leaf_f(const Vec3& wo, const Vec3& wi, float lobe) const {
    if (is_reciprocal()) return reciprocal_f(wo, wi, lobe);
    const Vec3 &incident = from_light() ? wi : wo, &leaving = from_light() ? wo : wi;
    const Incidence& in = incidence_at(incident);
    const Float4 subsurface = subsurface_f(in, incident, leaving);
    if (lobe == 0) return subsurface;
    return subsurface + in.reflectance * (lobe * surface_.normalisation(incident.z) / std::abs(leaving.z));
  }

  /// The Fourier series of leaf/solve/modes.h, by lane.
  Float4 subsurface_f(const Incidence& in, const Vec3& incident, const Vec3& leaving) const {
    const Float4 leaves = passage(leaving).over_cosine;
    const float sine_o = std::sqrt(sine2(leaving));
    return in.enters * leaves *
           hit_.table->series(incident.z < 0, !same_side(incident, leaving), in.nodes, hit_.table->nodes(sine_o),
                              cos_phi(incident, leaving, in.sine * sine_o), hit_.selection->columns);
  }

  float leaf_pdf(const Vec3& wo, const Vec3& wi, float lobe) const {
    const Choice& choice = choice_at(wo);
    const float cosine = std::abs(wi.z) * kInvPi;
    if (!same_side(wo, wi)) return choice.transmitted * cosine;
    const float subsurface = choice.reflected * cosine;
    return lobe == 0 ? subsurface : subsurface + choice.surface * lobe * surface_.normalisation(wo.z);
  }

  SolvedHit hit_;
  SurfaceLobe surface_;
  mutable Incidence incidence_;
  mutable Choice choice_;
};

}  // namespace frond
