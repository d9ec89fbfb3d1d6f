#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "core/params.h"
#include "core/wavelengths.h"
#include "leaf/table/depth_map.h"
#include "leaf/tissue/specimens.h"
#include "materials/lobes/incident.h"

namespace frond {

namespace detail {

inline constexpr Unit kDensity = "kg/m^3";

inline constexpr std::string_view kAbsorption[] = {"baranoski", "prospect"};
inline constexpr std::string_view kIncident[] = {"traced", "light", "reciprocal"};

// A parameter that may be a texture.
constexpr Param leaf_number(std::string_view name, Unit unit, Interval range, std::string_view doc,
                            PhysicalQuantity quantity = PhysicalQuantity::other) {
  return {
      .name = name, .kind = ParamKind::float_texture, .unit = unit, .range = range, .doc = doc, .quantity = quantity};
}

}  // namespace detail

/// Parameters of every leaf material, so that one can replace another in a scene. Parameters without a default are the
/// specimen's.
inline constexpr std::array kLeafParams{
    Param{.name = "specimen",
          .kind = ParamKind::string,
          .default_value = std::string_view("soybean"),
          .doc =
              "Named set of leaf parameters, from the literature or fitted to measurements (frond list specimens): the "
              "structure, and the parameters that are not given.",
          .choices = leaf::kSpecimenNames},
    detail::leaf_number("thickness", "m", {1e-6, 1e-2}, "Thickness of the leaf; by default the specimen's.",
                        PhysicalQuantity::leaf_thickness),
    detail::leaf_number(
        "mesophyllfraction", "", {0, 1},
        "Share of the thickness that absorbs; by default the specimen's. A content per leaf area is concentration "
        "x thickness x mesophyllfraction: 1 kg/m^2 is 1e5 ug/cm2 or 0.1 g/cm2 (docs/fit.md)."),
    detail::leaf_number("chlorophylla", detail::kDensity, {0, 100},
                        "Chlorophyll a in the mesophyll; by default the specimen's.", PhysicalQuantity::chlorophyll),
    detail::leaf_number("chlorophyllb", detail::kDensity, {0, 100},
                        "Chlorophyll b in the mesophyll; by default the specimen's.", PhysicalQuantity::chlorophyll),
    detail::leaf_number("carotenoids", detail::kDensity, {0, 100},
                        "Carotenoids in the mesophyll; by default the specimen's.", PhysicalQuantity::carotenoids),
    detail::leaf_number("protein", detail::kDensity, {0, 1500}, "Protein in the mesophyll; by default the specimen's.",
                        PhysicalQuantity::dry_matter),
    detail::leaf_number("cellulose", detail::kDensity, {0, 1500},
                        "Cellulose in the mesophyll; by default the specimen's.", PhysicalQuantity::dry_matter),
    detail::leaf_number("lignin", detail::kDensity, {0, 1500}, "Lignin in the mesophyll; by default the specimen's.",
                        PhysicalQuantity::dry_matter),
    detail::leaf_number("anthocyanins", detail::kDensity, {0, 100},
                        "Anthocyanins in the mesophyll, with PROSPECT-D's spectrum; by default the specimen's.",
                        PhysicalQuantity::anthocyanins),
    detail::leaf_number("brownpigments", "1/m", {0, 1e5},
                        "Brown pigments in the mesophyll, of dying leaves, with PROSPECT-D's spectrum; x thickness x "
                        "mesophyllfraction it is PROSPECT's content of them; by default the specimen's.",
                        PhysicalQuantity::brown_pigments),
    detail::leaf_number("drymatter", detail::kDensity, {0, 1500},
                        "Dry matter in the mesophyll, with PROSPECT-D's spectrum, instead of protein, cellulose and "
                        "lignin; by default the specimen's.",
                        PhysicalQuantity::dry_matter),
    detail::leaf_number(
        "otherabsorption", "1/m", {0, 1e5},
        "Absorption coefficient of the mesophyll's other constituents (starch, sugars, tannins), the same "
        "at every wavelength; by default the specimen's.",
        PhysicalQuantity::absorption),
    Param{.name = "absorption",
          .kind = ParamKind::string,
          .doc = "Specific absorption of chlorophylls, carotenoids and water. baranoski: as published with the model; "
                 "prospect: as calibrated for PROSPECT-D; by default the specimen's.",
          .choices = detail::kAbsorption},
    Param{.name = "spongyshare",
          .kind = ParamKind::real,
          .range = {0, 1},
          .doc =
              "Share of the mesophyll's absorption that lies below the air space, in bifacial leaves; by default the "
              "specimen's: 0 in the published model."},
    Param{.name = "cuticlerefractivity",
          .kind = ParamKind::real,
          .range = {0.1, 2},
          .doc = "Refractivity (refractive index - 1) of the cuticle, relative to the published one: 0.25 is an "
                 "effective index of 1.13 at 550 nm, as of a surface that hardly reflects; by default the specimen's, "
                 "1 in the published model."},
    detail::leaf_number("cuticleaspect", "", {0, 1000},
                        "Aspect ratio of the cuticle's undulations: the exponent of the surface lobe; by default the "
                        "specimen's."),
    detail::leaf_number("epidermisaspect", "", {0, 100},
                        "Aspect ratio of the epidermal cells' caps; by default the specimen's."),
    detail::leaf_number("spongyaspect", "", {0, 100},
                        "Aspect ratio of the spongy cells' caps; by default the specimen's."),
    detail::leaf_number("palisadeaspect", "", {0, 100},
                        "Aspect ratio of the palisade cells' caps, in bifacial leaves; by default the specimen's."),
    Param{.name = "pigments",
          .kind = ParamKind::string,
          .doc = "Spectrum files (.spd, .csv) of the specific absorption of further pigments, in nm and m^2/kg.",
          .list = true},
    Param{.name = "pigmentconcentrations",
          .kind = ParamKind::float_texture,
          .unit = detail::kDensity,
          .range = {0, 100},
          .doc = "Concentrations of these pigments in the mesophyll, one for each file.",
          .list = true},
    Param{.name = "sieve",
          .kind = ParamKind::boolean,
          .doc = "Absorption with the sieve and detour effects (Baranoski and Eng 2007); by default the specimen's, "
                 "which is false for soybean and maize."},
    Param{.name = "incident",
          .kind = ParamKind::string,
          .default_value = std::string_view("traced"),
          .doc =
              "Incident direction of the model, which is not reciprocal. traced: that of the traced ray, as published; "
              "light: that of the light; reciprocal: neither, the reciprocal BSDF closest to the model replaces it "
              "(docs/leaf_models.md).",
          .choices = detail::kIncident},
};

/// The leaf's parameters and then a material's own.
template <size_t N>
constexpr auto with_leaf_params(const Param (&own)[N]) {
  std::array<Param, kLeafParams.size() + N> all{};
  std::copy(own, own + N, std::copy(kLeafParams.begin(), kLeafParams.end(), all.begin()));
  return all;
}

/// The parameters of a material that cannot be reciprocal.
template <size_t N>
constexpr std::array<Param, N> without_reciprocal(std::array<Param, N> params) {
  for (Param& p : params)
    if (p.name == "incident") {
      p.doc =
          "Incident direction of the model, which is not reciprocal. traced: that of the traced ray, as published; "
          "light: that of the light.";
      p.choices = std::span(detail::kIncident).first(2);
    }
  return params;
}

/// The leaf that a scene describes, from the parameters above.
class LeafParams {
 public:
  /// Throws InputError if pigments and their concentrations differ in number, or a file cannot be read.
  explicit LeafParams(const Params& p);

  /// Constant parameters; where a texture gives a parameter, its largest value.
  const leaf::TissueParams& tissue() const { return tissue_; }
  /// Optical depth of the mesophyll, by point and wavelength.
  const leaf::DepthMap& depth() const { return depth_; }
  /// Whether no parameter varies over the leaf.
  bool is_constant() const { return depth_.is_constant() && aspects_are_constant(); }
  /// Whether no texture gives an aspect ratio.
  bool aspects_are_constant() const {
    return std::all_of(aspects_.begin(), aspects_.end(), [](const Aspect& a) { return !a; });
  }
  /// nullptr where the aspect ratio is constant.
  using Aspect = std::shared_ptr<const FloatTexture>;
  const Aspect& cuticle_aspect() const { return aspects_[0]; }
  const Aspect& epidermis_aspect() const { return aspects_[1]; }
  const Aspect& spongy_aspect() const { return aspects_[2]; }
  const Aspect& palisade_aspect() const { return aspects_[3]; }

  /// Incident direction that the scene requests.
  Incident incident() const { return incident_; }
  /// Whether the scene requests the reciprocal BSDF.
  bool is_reciprocal() const { return incident_ == Incident::reciprocal; }
  /// Range of the surface lobe's exponents: that of the cuticle's texture, or else `constant`.
  Interval exponents(double constant) const {
    return cuticle_aspect() ? cuticle_aspect()->range() : Interval{constant, constant};
  }
  /// Name of the specimen, for the log.
  std::string specimen() const { return specimen_; }

  /// Throws InputError if a texture gives the aspect ratio of an inner wall: for materials whose tables hold for one
  /// tissue. The cuticle affects the surface alone.
  void refuse_wall_textures(const Params& p) const;

  /// Throws InputError if the optical constants or a pigment's data do not cover the wavelengths.
  void check_wavelengths(const WavelengthStrategy& wavelengths) const;

 private:
  struct PigmentData {
    std::string file;
    Interval range_nm;
  };
  using Varying = std::vector<leaf::DepthMap::Varying>;

  /// Fill in the members before `depth_`.
  leaf::DepthMap read(const Params& p);
  void read_pigments(const Params& p, Varying& varying);

  std::string specimen_;
  Location where_, pigments_where_;
  leaf::TissueParams tissue_;
  std::array<Aspect, 4> aspects_;
  std::vector<PigmentData> pigment_data_;
  Incident incident_;
  leaf::DepthMap depth_;
};

}  // namespace frond
