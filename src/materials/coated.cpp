#include "materials/conductor_params.h"
#include "materials/lobes/layered.h"
#include "materials/roughness.h"

namespace frond {
namespace {

// Parameters and defaults are pbrt-v4's, so that its scene files render alike.
constexpr std::array kCoatMedium{Param{.name = "thickness",
                                       .kind = ParamKind::float_texture,
                                       .default_value = 0.01,
                                       .range = kAtLeastZero,
                                       .doc = "Optical thickness of the medium between the coat and the base."},
                                 Param{.name = "albedo",
                                       .kind = ParamKind::spectrum_texture,
                                       .default_value = 0.0,
                                       .range = {0, 1},
                                       .doc = "Single-scattering albedo of the medium."},
                                 Param{.name = "g",
                                       .kind = ParamKind::float_texture,
                                       .default_value = 0.0,
                                       .range = {-1, 1},
                                       .doc = "Mean cosine of the medium's phase function (Henyey-Greenstein)."},
                                 Param{.name = "maxdepth",
                                       .kind = ParamKind::integer,
                                       .default_value = 10,
                                       .range = {0, 1000},
                                       .doc = "Largest number of events of a random walk below the coat."},
                                 Param{.name = "nsamples",
                                       .kind = ParamKind::integer,
                                       .default_value = 1,
                                       .range = {1, 1000},
                                       .doc = "Number of random walks for each evaluation of the BSDF."}};

constexpr Param coat_eta(std::string_view name) {
  return {.name = name,
          .kind = ParamKind::unbounded,
          .default_value = 1.5,
          .doc = "Index of refraction of the coat over that outside."};
}

/// The coat and the medium below it, from their parameters.
class CoatParams {
 public:
  CoatParams(const Params& p, std::string_view eta, const RoughnessNames& roughness)
      : eta_(p.spectrum(eta)),
        roughness_(p, roughness),
        thickness_(p.float_texture("thickness")),
        g_(p.float_texture("g")),
        albedo_(p.spectrum_texture("albedo")),
        albedo_where_(p.where("albedo")),
        walks_{p.integer("maxdepth"), p.integer("nsamples")} {}

  void prepare(const WavelengthStrategy& wavelengths) const {
    check_range(albedo_->range_nm(), wavelengths, albedo_where_, "albedo");
  }
  LaneIndices indices(const SampledWavelengths& lambda) const { return {eta_->sample(lambda), lambda}; }
  /// Makes the BSDF of the coat over `base`.
  template <class Base>
  const Bsdf* make_layered_bsdf(const Base& base, const LaneIndices& indices, const Hit& hit,
                                const SampledWavelengths& lambda, Arena& arena) const {
    const CoatMedium medium{thickness_->evaluate(hit.at), albedo_->evaluate(hit.at, lambda) * indices.mask(),
                            g_->evaluate(hit.at)};
    return arena.make<LayeredBsdf<Base>>(roughness_.at(hit.at), indices, base, medium, walks_);
  }
  bool has_direction() const { return roughness_.has_direction(); }

 private:
  SpectrumPtr eta_;
  Roughness roughness_;
  std::shared_ptr<const FloatTexture> thickness_, g_;
  std::shared_ptr<const SpectrumTexture> albedo_;
  Location albedo_where_;
  LayerWalks walks_;
};

constexpr Param kReflectance{.name = "reflectance",
                             .kind = ParamKind::spectrum_texture,
                             .default_value = 0.5,
                             .range = {0, 1},
                             .doc = "Reflectance of the surface below the coat."};
constexpr auto kCoatedDiffuse = joined(std::array{kReflectance, coat_eta("eta")}, roughness_params(kRoughnessNames),
                                       std::array{kRemapRoughness}, kCoatMedium);

// Material "coateddiffuse": a DiffuseBase under a dielectric coat.
class CoatedDiffuse final : public Material {
 public:
  explicit CoatedDiffuse(const Params& p)
      : reflectance_(p.spectrum_texture("reflectance")),
        where_(p.where("reflectance")),
        coat_(p, "eta", kRoughnessNames) {}

  void prepare(const Preparation& preparation) override {
    check_range(reflectance_->range_nm(), preparation.wavelengths, where_, "reflectance");
    coat_.prepare(preparation.wavelengths);
  }
  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    const LaneIndices indices = coat_.indices(lambda);
    return coat_.make_layered_bsdf(DiffuseBase(reflectance_->evaluate(hit.at, lambda) * indices.mask()), indices, hit,
                                   lambda, arena);
  }
  bool is_reciprocal() const override { return true; }
  bool needs_details() const override { return coat_.has_direction(); }

 private:
  std::shared_ptr<const SpectrumTexture> reflectance_;
  Location where_;
  CoatParams coat_;
};

// Names as in pbrt-v4: the coat is its "interface".
constexpr RoughnessNames kCoatRoughness{"interface.roughness", "interface.uroughness", "interface.vroughness"};
constexpr RoughnessNames kMetalRoughness{"conductor.roughness", "conductor.uroughness", "conductor.vroughness"};
constexpr MetalNames kCoatedMetalNames{"conductor.eta", "conductor.k", "reflectance"};
constexpr auto kCoatedConductor =
    joined(std::array{coat_eta("interface.eta")}, roughness_params(kCoatRoughness), metal_params(kCoatedMetalNames),
           roughness_params(kMetalRoughness), std::array{kRemapRoughness}, kCoatMedium);

// Material "coatedconductor": a ConductorBase under a dielectric coat, each with its own roughness.
class CoatedConductor final : public Material {
 public:
  explicit CoatedConductor(const Params& p)
      : metal_(p, kCoatedMetalNames), roughness_(p, kMetalRoughness), coat_(p, "interface.eta", kCoatRoughness) {}

  void prepare(const Preparation& preparation) override {
    metal_.prepare(preparation.wavelengths);
    coat_.prepare(preparation.wavelengths);
  }
  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    const LaneIndices indices = coat_.indices(lambda);
    const ConductorIndices metal = metal_.at(hit.at, lambda);
    const Float4 eta = indices.eta().v;
    // Fresnel's formula requires indices relative to the medium before the metal, which is the coat's.
    const ConductorIndices below_coat(SampledSpectrum(metal.eta.v / eta), SampledSpectrum(metal.k.v / eta));
    return coat_.make_layered_bsdf(ConductorBase(roughness_.at(hit.at), below_coat, indices.mask()), indices, hit,
                                   lambda, arena);
  }
  bool is_reciprocal() const override { return true; }
  bool needs_details() const override { return coat_.has_direction() || roughness_.has_direction(); }

 private:
  Metal metal_;
  Roughness roughness_;
  CoatParams coat_;
};

}  // namespace

extern const MaterialInfo coated_diffuse_material{
    {"material", "coateddiffuse", "Lambertian surface under a dielectric coat.", "Guo, Hasan and Zhao 2018; pbrt-v4",
     kCoatedDiffuse},
    make_material<CoatedDiffuse>};

extern const MaterialInfo coated_conductor_material{{"material", "coatedconductor", "Metal under a dielectric coat.",
                                                     "Guo, Hasan and Zhao 2018; pbrt-v4", kCoatedConductor},
                                                    make_material<CoatedConductor>};

}  // namespace frond
