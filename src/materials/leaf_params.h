#pragma once

#include <algorithm>
#include <array>

#include "core/params.h"
#include "leaf/specimens.h"

namespace frond {

namespace detail {

constexpr auto specimen_names() {
  std::array<std::string_view, std::size(leaf::kSpecimens)> names;
  for (size_t i = 0; i < names.size(); ++i) names[i] = leaf::kSpecimens[i].name;
  return names;
}
inline constexpr auto kSpecimenNames = specimen_names();

inline constexpr Unit kDensity = "kg/m^3";

constexpr Param leaf_number(std::string_view name, Unit unit, Interval range, std::string_view doc) {
  return {.name = name, .kind = ParamKind::real, .unit = unit, .range = range, .doc = doc};
}

}  // namespace detail

/// What every leaf material lets a scene say of the leaf, so that one can stand for another. Without a default of their
/// own, numbers are those of the specimen.
inline constexpr std::array kLeafParams{
    Param{.name = "specimen",
          .kind = ParamKind::string,
          .default_value = std::string_view("soybean"),
          .doc = "A leaf from the literature: its structure, and the numbers that are not given.",
          .choices = detail::kSpecimenNames},
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
    detail::leaf_number("cuticleaspect", "", {0, 1000},
                        "Aspect ratio of the cuticle's undulations: the exponent of the surface lobe; by default the "
                        "specimen's."),
    detail::leaf_number("epidermisaspect", "", {0, 100},
                        "Aspect ratio of the epidermal cells' caps; by default the specimen's."),
    detail::leaf_number("spongyaspect", "", {0, 100},
                        "Aspect ratio of the spongy cells' caps; by default the specimen's."),
    detail::leaf_number("palisadeaspect", "", {0, 100},
                        "Aspect ratio of the palisade cells' caps, in bifacial leaves; by default the specimen's."),
    Param{.name = "sieve",
          .kind = ParamKind::boolean,
          .default_value = false,
          .doc = "Absorb with the sieve and detour effects of the later model (Baranoski and Eng 2007)."},
};

/// The leaf's parameters and then a material's own.
template <size_t N>
constexpr auto with_leaf_params(const Param (&own)[N]) {
  std::array<Param, kLeafParams.size() + N> all{};
  std::copy(own, own + N, std::copy(kLeafParams.begin(), kLeafParams.end(), all.begin()));
  return all;
}

leaf::TissueParams leaf_params(const Params& p);

}  // namespace frond
