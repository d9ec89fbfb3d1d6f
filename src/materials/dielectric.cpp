#include "materials/lobes/dielectric.h"

#include "core/material.h"
#include "materials/roughness.h"

namespace frond {
namespace {

// An index of 0 counts as 1, as in pbrt-v4 (LaneIndices).
constexpr Param kEta{.name = "eta",
                     .kind = ParamKind::unbounded,
                     .default_value = 1.5,
                     .doc = "Index of refraction inside (against the normal) over that outside."};
constexpr auto kDielectric = joined(std::array{kEta}, roughness_params(kRoughnessNames), std::array{kRemapRoughness});

// Material "dielectric". The interface is smooth if its roughness is below a threshold, or if no lane is refracted:
// rough facets of index 1 have no effect.
class Dielectric final : public Material {
 public:
  explicit Dielectric(const Params& p) : eta_(p.spectrum("eta")), roughness_(p, kRoughnessNames) {}

  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    const LaneIndices indices(eta_->sample(lambda), lambda);
    const TrowbridgeReitz facets = roughness_.at(hit.at);
    if (facets.is_smooth() || indices.are_all_one()) return arena.make<SmoothDielectricBsdf>(indices);
    return arena.make<RoughDielectricBsdf>(facets, indices);
  }
  bool is_reciprocal() const override { return true; }
  bool refracts() const override { return true; }
  bool needs_details() const override { return roughness_.has_direction(); }

 private:
  SpectrumPtr eta_;
  Roughness roughness_;
};

constexpr Param kThinDielectric[] = {{.name = "eta",
                                      .kind = ParamKind::unbounded,
                                      .default_value = 1.5,
                                      .doc = "Index of refraction of the pane over that outside."}};

// Material "thindielectric": both faces of a pane as one surface.
class ThinDielectric final : public Material {
 public:
  explicit ThinDielectric(const Params& p) : eta_(p.spectrum("eta")) {}

  const Bsdf* evaluate(const Hit&, const SampledWavelengths& lambda, Arena& arena) const override {
    return arena.make<ThinDielectricBsdf>(LaneIndices(eta_->sample(lambda), lambda));
  }
  bool is_reciprocal() const override { return true; }

 private:
  SpectrumPtr eta_;
};

}  // namespace

extern const MaterialInfo dielectric_material{
    {"material", "dielectric", "Dielectric such as glass or water: smooth or rough, with dispersion.",
     "Walter et al. 2007; Heitz 2018; pbrt-v4", kDielectric},
    make_material<Dielectric>};

extern const MaterialInfo thin_dielectric_material{
    {"material", "thindielectric", "Thin dielectric pane: reflects and transmits without refraction.", "pbrt-v4",
     kThinDielectric},
    make_material<ThinDielectric>};

}  // namespace frond
