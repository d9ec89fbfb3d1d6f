#include <fmt/format.h>

#include "core/material.h"
#include "materials/lobes/dielectric.h"
#include "materials/lobes/tabulated_bssrdf.h"
#include "materials/roughness.h"
#include "spectra/check_range.h"
#include "spectra/color/substances.h"

namespace frond {
namespace {

// Parameters and defaults are pbrt-v4's, so that its scene files render alike.
constexpr std::array kMedium{
    Param{.name = "name",
          .kind = ParamKind::string,
          .doc = "Substance that gives both coefficients, for a unit of 1 mm: \"Apple\", \"Potato\" and others, as "
                 "for medium \"homogeneous\". By default \"Wholemilk\".",
          .in_place_of_others = true},
    Param{.name = "sigma_a",
          .kind = ParamKind::spectrum_texture,
          .unit = "1/unit",
          .range = kAtLeastZero,
          .doc = "Absorption coefficient."},
    Param{.name = "sigma_s",
          .kind = ParamKind::spectrum_texture,
          .unit = "1/unit",
          .range = kAtLeastZero,
          .doc = "Scattering coefficient."},
    Param{.name = "reflectance",
          .kind = ParamKind::spectrum_texture,
          .doc = "Share of the light that enters the medium and leaves it again, instead of the coefficients.",
          .in_place_of_others = true},
    Param{.name = "mfp",
          .kind = ParamKind::spectrum_texture,
          .default_value = 1.0,
          .unit = "unit",
          .range = kAtLeastZero,
          .doc = "With \"reflectance\": mean free path."},
    Param{.name = "scale",
          .kind = ParamKind::real,
          .default_value = 1.0,
          .range = kAtLeastZero,
          .doc = "Factor of the coefficients, or of the mean free path."},
    Param{.name = "eta",
          .kind = ParamKind::real,
          .default_value = 1.33,
          .range = {1, 3},
          .doc = "Index of refraction of the medium over that outside."},
    Param{.name = "g",
          .kind = ParamKind::real,
          .default_value = 0.0,
          .range = {-0.99, 0.99},
          .doc = "Mean cosine of the phase function (Henyey-Greenstein); above 0: forward. Substances have 0."}};
constexpr auto kSubsurface = joined(kMedium, roughness_params(kRoughnessNames), std::array{kRemapRoughness});

/// Extinction coefficient, 1/unit, and single-scattering albedo.
struct Extinction {
  SampledSpectrum sigma_t, albedo;
};

/// Coefficients by point: of a substance, given, or from the reflectance.
class SubsurfaceMedium {
 public:
  /// Throws InputError for parameters that exclude each other.
  explicit SubsurfaceMedium(const Params& p) : scale_(float(p.real("scale"))) {
    const bool has_sigma = p.given("sigma_a") || p.given("sigma_s");
    if (p.given("name")) exclude(p, "name", {"sigma_a", "sigma_s", "reflectance", "mfp"});
    if (has_sigma) exclude(p, p.given("sigma_a") ? "sigma_a" : "sigma_s", {"reflectance", "mfp"});
    if (p.given("mfp") && !p.given("reflectance"))
      fail(p.where("mfp"), "\"mfp\" has no effect without \"reflectance\"");
    if (p.given("reflectance")) {
      is_by_reflectance_ = true;
      set({p.spectrum_texture("reflectance"), "reflectance", p.where("reflectance")},
          {p.spectrum_texture("mfp"), "mfp", p.where("mfp")});
    } else if (has_sigma) {
      for (const auto& [given, missing] : {std::pair{"sigma_a", "sigma_s"}, std::pair{"sigma_s", "sigma_a"}})
        if (!p.given(missing)) fail(p.where(given), "\"{}\" is given without \"{}\"", given, missing);
      set({p.spectrum_texture("sigma_a"), "sigma_a", p.where("sigma_a")},
          {p.spectrum_texture("sigma_s"), "sigma_s", p.where("sigma_s")});
    } else {
      const std::string name = p.given("name") ? p.string("name") : "Wholemilk";
      const auto substance = substance_coefficients(name, p.where("name"), "substance");
      set({std::make_shared<ConstantSpectrumTexture>(substance.sigma_a), "name", p.where("name")},
          {std::make_shared<ConstantSpectrumTexture>(substance.sigma_s), "name", p.where("name")});
    }
  }

  void prepare(const WavelengthStrategy& wavelengths) const {
    for (const Part& part : parts_) check_range(part.texture->range_nm(), wavelengths, part.where, part.name);
  }

  Extinction at(const TexturePoint& point, const SampledWavelengths& lambda, const BeamDiffusion& table) const {
    const SampledSpectrum first = parts_[0].texture->evaluate(point, lambda),
                          second = parts_[1].texture->evaluate(point, lambda) * scale_;
    Extinction e;
    for (int i = 0; i < kLanes; ++i) {
      if (!lambda.is_active(i)) continue;
      if (is_by_reflectance_) {
        e.sigma_t[i] = second[i] > 0 ? 1 / second[i] : 0;
        e.albedo[i] = table.albedo(first[i]);
      } else {
        e.sigma_t[i] = first[i] * scale_ + second[i];
        e.albedo[i] = e.sigma_t[i] > 0 ? second[i] / e.sigma_t[i] : 0;
      }
    }
    return e;
  }

 private:
  struct Part {
    std::shared_ptr<const SpectrumTexture> texture;
    std::string_view name;
    Location where;
  };
  void set(Part first, Part second) { parts_ = {std::move(first), std::move(second)}; }

  static void exclude(const Params& p, std::string_view name, std::initializer_list<std::string_view> others) {
    for (const std::string_view other : others)
      if (p.given(other)) fail(p.where(other), "\"{}\" and \"{}\" exclude each other", other, name);
  }

  float scale_;
  bool is_by_reflectance_ = false;
  std::array<Part, 2> parts_;  ///< sigma_a and sigma_s, or reflectance and mean free path
};

// Material "subsurface": a homogeneous medium below a dielectric interface.
class Subsurface final : public Material, public SubsurfaceMaterial {
 public:
  explicit Subsurface(const Params& p)
      : medium_(p),
        eta_(float(p.real("eta"))),
        g_(float(p.real("g"))),
        transmitted_(float(1 - 2 * fresnel_moment(double(eta_), 1))),
        roughness_(p, kRoughnessNames) {
    if (p.given("reflectance") || p.given("sigma_a") || g_ == 0) return;
    p.warn("g", "\"g\" has no effect: the coefficients of substances are reduced ones");
    g_ = 0;
  }

  void prepare(const Preparation& preparation) override {
    medium_.prepare(preparation.wavelengths);
    table_ = preparation.share<BeamDiffusion>(fmt::format("beam diffusion {} {}", g_, eta_), [&] {
      return BeamDiffusion(double(g_), double(eta_), preparation.pool);
    });
  }
  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    const LaneIndices indices(SampledSpectrum(eta_), lambda);
    const TrowbridgeReitz facets = roughness_.at(hit.at);
    if (facets.is_smooth() || indices.are_all_one()) return arena.make<SmoothDielectricBsdf>(indices);
    return arena.make<RoughDielectricBsdf>(facets, indices);
  }
  const Bssrdf& bssrdf(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    const Extinction medium = medium_.at(hit.at, lambda, *table_);
    const InterfaceExitBsdf exit(eta_, transmitted_, lane_mask(lambda));
    return *arena.make<TabulatedBssrdf>(*table_, hit, medium.sigma_t, medium.albedo, lambda, exit);
  }
  bool is_reciprocal() const override { return true; }
  bool refracts() const override { return true; }
  bool needs_details() const override { return roughness_.has_direction(); }

 private:
  SubsurfaceMedium medium_;
  float eta_, g_;
  float transmitted_;  ///< diffuse transmittance of the interface from outside
  Roughness roughness_;
  std::shared_ptr<const BeamDiffusion> table_;
};

}  // namespace

extern const MaterialInfo subsurface_material{
    {"material", "subsurface", "Translucent body: light enters it and leaves it elsewhere, as in fruits and petals.",
     "Jensen et al. 2001; Habel et al. 2013; pbrt-v4", kSubsurface},
    make_material<Subsurface>};

}  // namespace frond
