#pragma once

#include <iterator>

#include "leaf/tissue/tissue_params.h"

namespace frond::leaf {

/// A leaf measured by botanists, ready to use.
struct Specimen {
  std::string_view name, doc;
  TissueParams params;
};

/// Apart from the specimens, which hold vectors: g++ 12 takes an array of such for no constant where UBSan is on.
inline constexpr std::string_view kSpecimenNames[] = {"soybean", "maize"};

/// Baranoski 2006 (Remote Sensing of Environment 100:335-347); Baranoski and Eng 2007 (IEEE TGRS 45:2593-2599).
inline const Specimen kSpecimens[] = {
    {kSpecimenNames[0],
     "Soybean, a bifacial leaf.",
     {.structure = Structure::bifacial,
      .thickness_m = 1.66e-4,
      .mesophyll_fraction = 0.5,
      .chlorophyll_a = 3.9775,
      .chlorophyll_b = 1.1613,
      .carotenoids = 1.1323,
      .protein = 78.7059,
      .cellulose = 37.7565,
      .lignin = 10.7441,
      .cuticle_aspect = 5,
      .epidermis_aspect = 5,
      .spongy_aspect = 5,
      .palisade_aspect = 1}},
    {kSpecimenNames[1],
     "Maize, a unifacial leaf.",
     {.structure = Structure::unifacial,
      .thickness_m = 2.04e-4,
      .mesophyll_fraction = 0.8,
      .chlorophyll_a = 2.895146,
      .chlorophyll_b = 0.79866,
      .carotenoids = 0.658895,
      .protein = 53.08714,
      .cellulose = 53.18709,
      .lignin = 6.05853,
      .cuticle_aspect = 10,
      .epidermis_aspect = 5,
      .spongy_aspect = 5,
      .palisade_aspect = 5}},  // a unifacial leaf has no palisade: unused
};

static_assert(std::size(kSpecimens) == std::size(kSpecimenNames));

/// nullptr where there is none of that name.
inline const Specimen* find_specimen(std::string_view name) {
  for (const Specimen& specimen : kSpecimens)
    if (specimen.name == name) return &specimen;
  return nullptr;
}

}  // namespace frond::leaf
