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

inline constexpr std::string_view kIncident[] = {"traced", "light", "reciprocal"};

constexpr Param leaf_number(std::string_view name, Unit unit, Interval range, std::string_view doc) {
  return {.name = name, .kind = ParamKind::float_texture, .unit = unit, .range = range, .doc = doc};
}

}  // namespace detail

/// What every leaf material lets a scene say of the leaf, so that one can stand for another. Without a default of their
/// own, numbers are those of the specimen.
inline constexpr std::array kLeafParams{
    Param{.name = "specimen",
          .kind = ParamKind::string,
          .default_value = std::string_view("soybean"),
          .doc =
              "A leaf of the literature, or one fitted to measurements (frond list specimens): its structure, and the "
              "numbers that are not given.",
          .choices = leaf::kSpecimenNames},
    detail::leaf_number("thickness", "m", {1e-6, 1e-2}, "Thickness of the leaf; by default the specimen's."),
    detail::leaf_number("mesophyllfraction", "", {0, 1},
                        "Part of the thickness that absorbs; by default the specimen's."),
    detail::leaf_number("chlorophylla", detail::kDensity, {0, 100},
                        "Chlorophyll a in the mesophyll; by default the specimen's."),
    detail::leaf_number("chlorophyllb", detail::kDensity, {0, 100},
                        "Chlorophyll b in the mesophyll; by default the specimen's."),
    detail::leaf_number("carotenoids", detail::kDensity, {0, 100},
                        "Carotenoids in the mesophyll; by default the specimen's."),
    detail::leaf_number("protein", detail::kDensity, {0, 1500}, "Protein in the mesophyll; by default the specimen's."),
    detail::leaf_number("cellulose", detail::kDensity, {0, 1500},
                        "Cellulose in the mesophyll; by default the specimen's."),
    detail::leaf_number("lignin", detail::kDensity, {0, 1500}, "Lignin in the mesophyll; by default the specimen's."),
    detail::leaf_number("otherabsorption", "1/m", {0, 1e5},
                        "Absorption of what else is in the mesophyll (starch, sugars, tannins), at every wavelength "
                        "alike; by default the specimen's."),
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
          .doc = "Files (.spd) of the specific absorption of further pigments, in nm and m^2/kg.",
          .list = true},
    Param{.name = "pigmentconcentrations",
          .kind = ParamKind::float_texture,
          .unit = detail::kDensity,
          .range = {0, 100},
          .doc = "Concentrations of these pigments in the mesophyll, one for each file.",
          .list = true},
    Param{.name = "sieve",
          .kind = ParamKind::boolean,
          .doc = "Absorb with the sieve and detour effects of the later model (Baranoski and Eng 2007); by default the "
                 "specimen's, which of soybean and maize is false."},
    Param{.name = "incident",
          .kind = ParamKind::string,
          .default_value = std::string_view("traced"),
          .doc =
              "Incident direction of the model, which is not reciprocal: that of the traced ray, as published, or of "
              "the light; reciprocal: of neither, by the reciprocal BSDF closest to the model "
              "(docs/reciprocal_leaf.md).",
          .choices = detail::kIncident},
};

/// The leaf's parameters and then a material's own.
template <size_t N>
constexpr auto with_leaf_params(const Param (&own)[N]) {
  std::array<Param, kLeafParams.size() + N> all{};
  std::copy(own, own + N, std::copy(kLeafParams.begin(), kLeafParams.end(), all.begin()));
  return all;
}

/// Of a material that cannot be reciprocal.
template <size_t N>
constexpr std::array<Param, N> without_reciprocal(std::array<Param, N> params) {
  for (Param& p : params)
    if (p.name == "incident") {
      p.doc =
          "What the model, which is not reciprocal, takes for its incident ray: the one that is traced, as published, "
          "or "
          "the light.";
      p.choices = std::span(detail::kIncident).first(2);
    }
  return params;
}

/// A leaf as a scene gives it.
class LeafParams {
 public:
  explicit LeafParams(const Params& p);

  /// What is constant; where a texture stands for a number, the greatest that it can be.
  const leaf::TissueParams& tissue() const { return tissue_; }
  const leaf::DepthMap& depth() const { return depth_; }
  /// Whether nothing varies over the leaf.
  bool is_constant() const { return depth_.is_constant() && aspects_are_constant(); }
  bool aspects_are_constant() const {
    return std::all_of(aspects_.begin(), aspects_.end(), [](const Aspect& a) { return !a; });
  }
  /// nullptr where the aspect ratio is constant.
  using Aspect = std::shared_ptr<const FloatTexture>;
  const Aspect& cuticle_aspect() const { return aspects_[0]; }
  const Aspect& epidermis_aspect() const { return aspects_[1]; }
  const Aspect& spongy_aspect() const { return aspects_[2]; }
  const Aspect& palisade_aspect() const { return aspects_[3]; }

  Incident incident() const { return incident_; }
  bool is_reciprocal() const { return incident_ == Incident::reciprocal; }
  /// Exponents of the surface's lobe that the texture of the cuticle gives, or else this one.
  Interval exponents(double constant) const {
    return cuticle_aspect() ? cuticle_aspect()->range() : Interval{constant, constant};
  }
  std::string specimen() const { return specimen_; }

  /// Throws InputError where a texture says how the walls inside spread light, for materials whose tables hold for one
  /// tissue. The cuticle shapes the surface alone.
  void refuse_wall_textures(const Params& p) const;

  /// Throws InputError where the optical constants or a pigment's data do not reach the wavelengths.
  void check_wavelengths(const WavelengthStrategy& wavelengths) const;

 private:
  struct PigmentData {
    std::string file;
    Interval range_nm;
  };
  using Varying = std::vector<leaf::DepthMap::Varying>;

  /// Fill in what the members before `depth_` hold.
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
