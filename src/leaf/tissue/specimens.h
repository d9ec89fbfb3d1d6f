#pragma once

#include <algorithm>
#include <iterator>

#include "leaf/tissue/leaf_numbers.h"

namespace frond::leaf {

/// A named set of leaf parameters.
struct Specimen {
  std::string_view name, doc;
  std::string_view source;  ///< source of the parameters, and their accuracy
  TissueParams params;
};

/// Separate from the specimens, which contain vectors: with UBSan g++ 12 does not accept an array of those as a
/// constant.
inline constexpr std::string_view kSpecimenNames[] = {"soybean",     "maize", "lettuce", "tomato",
                                                      "walnut",      "grape", "toyon",   "soybean-lopex",
                                                      "maize-lopex", "red",   "autumn"};

/// A leaf with these numbers.
template <size_t n>
TissueParams leaf_of(TissueParams p, const std::string_view (&names)[n], const double (&values)[n]) {
  for (size_t i = 0; i < n; ++i) p.number(names[i]) = values[i];
  return p;
}

/// Numbers of the published leaves, and of leaves fitted by `frond fit`. A fit does not determine the cuticle's shape:
/// fitted leaves have the published one.
inline constexpr std::string_view kPublished[] = {
    "thickness", "mesophyllfraction", "chlorophylla",    "chlorophyllb", "carotenoids",   "protein", "cellulose",
    "lignin",    "cuticleaspect",     "epidermisaspect", "spongyaspect", "palisadeaspect"};
inline constexpr std::string_view kFitted[] = {
    "thickness",      "chlorophylla", "chlorophyllb",       "carotenoids",     "anthocyanins",
    "brownpigments",  "drymatter",    "otherabsorption",    "epidermisaspect", "spongyaspect",
    "palisadeaspect", "spongyshare",  "cuticlerefractivity"};
inline const TissueParams kFittedLeaf{.mesophyll_fraction = 0.5,
                                      .absorption_tables = AbsorptionTables::prospect,
                                      .cuticle_aspect = 5,
                                      .sieve_and_detour = true};

/// Sources of the first two: Baranoski 2006 (Remote Sensing of Environment 100:335-347); Baranoski and Eng 2007 (IEEE
/// TGRS 45:2593-2599). Of the others docs/fit.md says which parameters the measurements determine.
// clang-format off
inline const Specimen kSpecimens[] = {
    {kSpecimenNames[0], "Soybean, a bifacial leaf.", "Baranoski 2006, measured by botanists.",
     leaf_of({.structure = Structure::bifacial}, kPublished,
             {1.66e-4, 0.5, 3.9775, 1.1613, 1.1323, 78.7059, 37.7565, 10.7441, 5, 5, 5, 1})},
    {kSpecimenNames[1], "Maize, a unifacial leaf.", "Baranoski and Eng 2007, measured by botanists.",
     leaf_of({.structure = Structure::unifacial}, kPublished,  // without a palisade: the last is unused
             {2.04e-4, 0.8, 2.895146, 0.79866, 0.658895, 53.08714, 53.18709, 6.05853, 10, 5, 5, 5})},
    // Fitted by `frond fit`.
    {kSpecimenNames[2], "Lettuce, as a bifacial leaf with the sieve effect.",
     "Fitted to a leaf of LOPEX93: RMSE 0.0059.",
     leaf_of(kFittedLeaf, kFitted,
             {0.0004912, 1.027, 0.2999, 0.3586, 0.04265, 0, 77.75, 61.55, 1.061, 0.7001, 20, 0.1688, 0.9603})},
    {kSpecimenNames[3], "Tomato, as a bifacial leaf with the sieve effect.",
     "Fitted to a leaf of LOPEX93: RMSE 0.0046.",
     leaf_of(kFittedLeaf, kFitted,
             {0.0002846, 2.446, 0.7141, 0.7864, 0.1069, 0, 148.5, 172.5, 2.289, 20, 6.286, 0.06353, 0.992})},
    {kSpecimenNames[4], "Walnut, as a bifacial leaf with the sieve effect.",
     "Fitted to a leaf of LOPEX93: RMSE 0.0076.",
     leaf_of(kFittedLeaf, kFitted,
             {0.0002154, 3.326, 0.971, 0.9797, 0.1933, 0, 416.8, 86.72, 3.945, 0.7, 5.326, 0.0001, 1.082})},
    {kSpecimenNames[5], "Grape vine, as a bifacial leaf with the sieve effect.",
     "Fitted to a leaf of the University of California, Davis: RMSE 0.0221.",
     leaf_of(kFittedLeaf, kFitted,
             {0.0002581, 2.876, 0.8397, 0.9105, 0.25, 0, 612.9, 114.5, 7.881, 0.7, 0.7028, 0.3557, 1.193})},
    {kSpecimenNames[6], "Toyon, as a bifacial leaf with the sieve effect.",
     "Fitted to a leaf of the University of California, Davis: RMSE 0.0141.",
     leaf_of(kFittedLeaf, kFitted,
             {0.0003472, 2.129, 0.6215, 0.9191, 0.1638, 0, 1070, 51.22, 0.7952, 0.7, 0.7, 0.434, 1.02})},
    {kSpecimenNames[7], "Soybean, as a bifacial leaf with the sieve effect.",
     "Fitted to a leaf of LOPEX93: RMSE 0.0059.",
     leaf_of(kFittedLeaf, kFitted,
             {0.0001569, 3.615, 1.055, 1.194, 0.1189, 0, 293.9, 225.2, 2.375, 0.7, 4.327, 0.01513, 1.022})},
    {kSpecimenNames[8], "Maize, as a bifacial leaf with the sieve effect.", "Fitted to a leaf of LOPEX93: RMSE 0.0103.",
     leaf_of(kFittedLeaf, kFitted,
             {0.0003135, 4.04, 1.18, 1.037, 0.001, 0, 202.2, 77.22, 3.897, 19.75, 6.775, 0.1635, 1.278})},
    // Fitted to leaves that PROSPECT-D computes (docs/outdoors.md has their contents), not to measurements.
    {kSpecimenNames[9], "Red leaf, with half the chlorophyll of a green one and 20 ug/cm2 of anthocyanins.",
     "Fitted to a leaf of PROSPECT-D: RMSE 0.0052.",
     leaf_of(kFittedLeaf, kFitted,
             {0.0001889, 1.685, 0.4919, 0.5272, 2.147, 0, 728.5, 234.2, 1.972, 20, 20, 0.1063, 0.9331})},
    {kSpecimenNames[10], "Autumn leaf, brown and dry, with little chlorophyll.",
     "Fitted to a leaf of PROSPECT-D: RMSE 0.0123.",
     leaf_of(kFittedLeaf, kFitted,
             {8.906e-05, 0.8552, 0.2497, 0.8634, 0.4352, 18590, 1500, 671.4, 0.7, 3.356, 1.595, 0.2919, 0.8863})},
};
// clang-format on

static_assert(std::size(kSpecimens) == std::size(kSpecimenNames));

/// The first specimen of a structure.
inline const Specimen& specimen_of(Structure structure) {
  return *std::ranges::find(kSpecimens, structure, [](const Specimen& s) { return s.params.structure; });
}

/// Returns the specimen of this name; nullptr if there is none.
inline const Specimen* find_specimen(std::string_view name) {
  for (const Specimen& specimen : kSpecimens)
    if (specimen.name == name) return &specimen;
  return nullptr;
}

}  // namespace frond::leaf
