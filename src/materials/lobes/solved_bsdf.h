#pragma once

#include <limits>

#include "core/bsdf.h"
#include "leaf/body_table.h"
#include "materials/lobes/surface_lobe.h"

namespace frond {

/// A solved leaf where it was hit, at the wavelengths of the path. What is pointed to outlives the BSDF.
struct SolvedHit {
  const leaf::BodyTable* table;
  leaf::BodyTable::Selection selection;
  const leaf::Lobe* surface;
  SampledSpectrum active;  ///< 1 in active lanes, 0 elsewhere
  bool from_light;         ///< wi, not wo, is the model's incident direction
};

/// A leaf by the solution of its walk: the surface's lobe, exactly, and the light that has been inside by its modes
/// over azimuth. Directions are drawn from the surface's lobe and a cosine lobe on either side, in the proportions of
/// the light that goes these ways.
class SolvedBsdf final : public Bsdf {
 public:
  explicit SolvedBsdf(const SolvedHit& hit) : hit_(hit), surface_(hit.surface) {}

  Lobes flags() const override {
    const Lobes way_round = hit_.from_light ? Lobes::from_light : Lobes::none;
    return Lobes::reflection | Lobes::transmission | Lobes::diffuse | Lobes::glossy | Lobes::surface | way_round;
  }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    return leaf_scatters(wo, wi) ? leaf_f(wo, wi, surface_.spread(wo, wi)) : SampledSpectrum();
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream& rng) const override {
    if (std::abs(wo.z) < kLeastCosine) return {};
    const Choice& choice = choice_at(wo);
    const bool off_surface = uc < choice.surface, reflects = uc < choice.surface + choice.reflected;
    Vec3 wi = off_surface ? surface_.sample(wo, u, rng).wi : sample_cosine_hemisphere(u);
    if (!off_surface && (wo.z < 0) == reflects) wi.z = -wi.z;
    if (!leaf_scatters(wo, wi)) return {};
    const float lobe = surface_.spread(wo, wi), density = leaf_pdf(wo, wi, lobe);
    if (density == 0) return {};  // black
    const Lobes side = reflects ? Lobes::reflection : Lobes::transmission;
    return BsdfSample{leaf_f(wo, wi, lobe), wi, density,
                      side | (off_surface ? Lobes::glossy | Lobes::surface : Lobes::diffuse)};
  }

  float pdf(const Vec3& wo, const Vec3& wi) const override {
    return leaf_scatters(wo, wi) ? leaf_pdf(wo, wi, surface_.spread(wo, wi)) : 0;
  }

  /// What the model says of its incident direction, whichever way round a path asks.
  void scatter(const Vec3& incident, RandomStream& rng, std::span<Scattered> rays) const override {
    SolvedHit hit = hit_;
    hit.from_light = false;
    const SolvedBsdf traced(hit);
    traced.Bsdf::scatter(incident, rng, rays);
  }

 private:
  /// Probabilities of the lobes for one wo.
  struct Choice {
    float cos_theta = std::numeric_limits<float>::quiet_NaN();
    float surface, reflected, transmitted;
  };

  /// What depends on the incident direction alone.
  struct Incidence {
    Vec3 direction{std::numeric_limits<float>::quiet_NaN(), 0, 0};
    float sine;
    leaf::BodyTable::Nodes nodes;
    SampledSpectrum reflectance;  ///< of the surface; 0 in lanes that are not active
    SampledSpectrum enters;       ///< 1 - reflectance, likewise
  };

  /// The way out through the surface of light that leaves at some cosine: (1 - F) / mu'.
  struct Passage {
    SampledSpectrum reflectance, cos_inside;
  };

  static float sine(const Vec3& w) { return std::min(std::sqrt(w.x * w.x + w.y * w.y), 1.f); }
  static float sum(const SampledSpectrum& s) { return (s[0] + s[1]) + (s[2] + s[3]); }

  /// Fresnel's formulae for light that comes from outside, where it always finds a way in.
  Passage passage(float cosine, float sine2) const {
    Passage p;
    for (size_t i = 0; i < kLanes; ++i) {
      const float n = hit_.selection.index.v[i];
      const float inside = std::sqrt(1 - sine2 / (n * n));
      const float s = (cosine - n * inside) / (cosine + n * inside), q = (n * cosine - inside) / (n * cosine + inside);
      p.reflectance.v[i] = (s * s + q * q) / 2;
      p.cos_inside.v[i] = inside;
    }
    return p;
  }

  /// f, pdf and sample come in turn for one direction: looked up once.
  const Incidence& incidence_at(const Vec3& incident) const {
    Incidence& in = incidence_;
    if (in.direction == incident) return in;
    in.direction = incident;
    in.sine = sine(incident);
    in.nodes = hit_.table->nodes(in.sine);
    in.reflectance = hit_.active * passage(std::abs(incident.z), in.sine * in.sine).reflectance;
    for (size_t i = 0; i < kLanes; ++i) in.enters.v[i] = hit_.active.v[i] - in.reflectance.v[i];
    return in;
  }

  SampledSpectrum share(const Incidence& in, bool from_below, bool crosses) const {
    return in.enters * hit_.table->share(from_below, crosses, in.nodes, hit_.selection.columns);
  }

  /// Each way keeps a little, so that no direction is left without density.
  const Choice& choice_at(const Vec3& wo) const {
    if (choice_.cos_theta == wo.z) return choice_;
    choice_.cos_theta = wo.z;
    const Incidence& in = incidence_at(wo);
    const bool below = wo.z < 0;
    const float surface = sum(in.reflectance);
    float reflected = sum(share(in, below, false)),
          transmitted = sum(share(in, hit_.from_light ? !below : below, true));
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

  SampledSpectrum leaf_f(const Vec3& wo, const Vec3& wi, float lobe) const {
    const Vec3 &incident = hit_.from_light ? wi : wo, &leaving = hit_.from_light ? wo : wi;
    const Incidence& in = incidence_at(incident);
    SampledSpectrum result = body_f(in, incident, leaving);
    if (lobe > 0) result += in.reflectance * (lobe * surface_.made_good(incident.z) / std::abs(leaving.z));
    return result;
  }

  SampledSpectrum body_f(const Incidence& in, const Vec3& incident, const Vec3& leaving) const {
    const float sine_o = sine(leaving), both = in.sine * sine_o;
    const float cos_phi =
        both > 0 ? std::clamp(-(incident.x * leaving.x + incident.y * leaving.y) / both, -1.f, 1.f) : 1;
    const Passage out = passage(std::abs(leaving.z), sine_o * sine_o);
    SampledSpectrum f = in.enters * hit_.table->series(incident.z < 0, !same_side(incident, leaving), in.nodes,
                                                       hit_.table->nodes(sine_o), cos_phi, hit_.selection.columns);
    for (size_t i = 0; i < kLanes; ++i) f.v[i] *= (1 - out.reflectance.v[i]) / out.cos_inside.v[i];
    return f;
  }

  float leaf_pdf(const Vec3& wo, const Vec3& wi, float lobe) const {
    const Choice& choice = choice_at(wo);
    const float cosine = std::abs(wi.z) * kInvPi;
    if (!same_side(wo, wi)) return choice.transmitted * cosine;
    const float body = choice.reflected * cosine;
    return lobe == 0 ? body : body + choice.surface * lobe * surface_.made_good(wo.z);
  }

  SolvedHit hit_;
  SurfaceLobe surface_;
  mutable Incidence incidence_;
  mutable Choice choice_;
};

}  // namespace frond
