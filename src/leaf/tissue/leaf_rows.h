#pragma once

#include "leaf/tissue/leaf_numbers.h"

namespace frond::leaf {

/// The rows of kLeafNumbers, for its definition.
using Quantity = PhysicalQuantity;
// clang-format off
inline constexpr LeafNumber kLeafRows[] = {
    {.name = "thickness", .action = LeafAction::length, .unit = "m", .range = {1e-6, 1e-2},
     .doc = "Thickness of the leaf; by default the specimen's.", .quantity = Quantity::leaf_thickness,
     .member = &TissueParams::thickness_m, .fit_range = {2e-6, 1e-2}},
    // Not fitted, since it acts only through its product with the thickness.
    {.name = "mesophyllfraction", .action = LeafAction::length, .range = {0, 1},
     .doc = "Share of the thickness that absorbs; by default the specimen's. A content per leaf area is concentration "
            "x thickness x mesophyllfraction: 1 kg/m^2 is 1e5 ug/cm2 or 0.1 g/cm2 (docs/fit.md).",
     .member = &TissueParams::mesophyll_fraction},
    {.name = "chlorophylla", .action = LeafAction::absorption, .unit = kMassPerVolume, .range = {0, 100},
     .doc = "Chlorophyll a in the mesophyll; by default the specimen's.", .quantity = Quantity::chlorophyll,
     .published = &Constants::chlorophyll, .prospect = &ProspectConstants::chlorophyll, .fluoresces = true,
     .content = {"chlorophyll", kMicrogramsPerCm2, "Cab", true}, .fit_range = {1e-3, 100}},
    {.name = "chlorophyllb", .action = LeafAction::absorption, .unit = kMassPerVolume, .range = {0, 100},
     .doc = "Chlorophyll b in the mesophyll; by default the specimen's.", .quantity = Quantity::chlorophyll,
     .published = &Constants::chlorophyll, .prospect = &ProspectConstants::chlorophyll, .fluoresces = true,
     .follows = "chlorophylla",
     .content = {"chlorophyll", kMicrogramsPerCm2, "Cab", true}},
    {.name = "carotenoids", .action = LeafAction::absorption, .unit = kMassPerVolume, .range = {0, 100},
     .doc = "Carotenoids in the mesophyll; by default the specimen's.", .quantity = Quantity::carotenoids,
     .published = &Constants::carotenoids, .prospect = &ProspectConstants::carotenoids,
     .content = {"carotenoids", kMicrogramsPerCm2, "Car", true}, .fit_range = {1e-3, 100}},
    {.name = "protein", .action = LeafAction::absorption, .unit = kMassPerVolume, .range = {0, 1500},
     .doc = "Protein in the mesophyll; by default the specimen's.", .quantity = Quantity::dry_matter,
     .published = &Constants::protein, .content = {"drymatter", kGramsPerCm2, "Cm", true}, .fit_range = {0.1, 1500},
     .little = 30, .only_with = AbsorptionTables::baranoski},
    {.name = "cellulose", .action = LeafAction::absorption, .unit = kMassPerVolume, .range = {0, 1500},
     .doc = "Cellulose in the mesophyll; by default the specimen's.", .quantity = Quantity::dry_matter,
     .published = &Constants::cellulose, .content = {"drymatter", kGramsPerCm2, "Cm", true}, .fit_range = {0.1, 1500},
     .little = 30, .only_with = AbsorptionTables::baranoski},
    {.name = "lignin", .action = LeafAction::absorption, .unit = kMassPerVolume, .range = {0, 1500},
     .doc = "Lignin in the mesophyll; by default the specimen's.", .quantity = Quantity::dry_matter,
     .published = &Constants::cellulose, .follows = "cellulose", .content = {"drymatter", kGramsPerCm2, "Cm", true},
     .only_with = AbsorptionTables::baranoski},
    {.name = "anthocyanins", .action = LeafAction::absorption, .unit = kMassPerVolume, .range = {0, 100},
     .doc = "Anthocyanins in the mesophyll, with PROSPECT-D's spectrum; by default the specimen's.",
     .quantity = Quantity::anthocyanins, .prospect = &ProspectConstants::anthocyanins,
     .content = {"anthocyanins", kMicrogramsPerCm2, "Cant"}, .fit_range = {1e-3, 100}, .little = 0.05,
     .only_with = AbsorptionTables::prospect},
    {.name = "brownpigments", .action = LeafAction::absorption, .unit = "1/m", .range = {0, 1e5},
     .doc = "Brown pigments in the mesophyll, of dying leaves, with PROSPECT-D's spectrum; x thickness x "
            "mesophyllfraction it is PROSPECT's content of them; by default the specimen's.",
     .quantity = Quantity::brown_pigments, .label = "brown pigments", .prospect = &ProspectConstants::brown_pigments,
     .content = {"brownpigments", kProspectUnits, "Cbrown"}, .fit_range = {1, 1e5}, .little = 20,
     .only_with = AbsorptionTables::prospect},
    // The model's mesophyll absorbs like pure water: no parameter.
    {.name = "water", .action = LeafAction::absorption, .unit = "1/m", .published = &Constants::water,
     .prospect = &ProspectConstants::water, .content = {"water", kGramsPerCm2, "Cw", true, kWaterConcentration}},
    // All of it, in place of protein, cellulose and lignin.
    {.name = "drymatter", .action = LeafAction::absorption, .unit = kMassPerVolume, .range = {0, 1500},
     .doc = "Dry matter in the mesophyll, with PROSPECT-D's spectrum, instead of protein, cellulose and lignin; by "
            "default the specimen's.", .quantity = Quantity::dry_matter, .prospect = &ProspectConstants::dry_matter,
     .content = {"drymatter", kGramsPerCm2, "Cm", true}, .fit_range = {0.1, 1500}, .little = 100,
     .only_with = AbsorptionTables::prospect},
    {.name = "otherabsorption", .action = LeafAction::absorption, .unit = "1/m", .range = {0, 1e5},
     .doc = "Absorption coefficient of the mesophyll's other constituents (starch, sugars, tannins), the same at every "
            "wavelength; by default the specimen's.", .quantity = Quantity::absorption, .fit_range = {1, 1e4},
     .little = 30},
    {.name = "cuticleaspect", .action = LeafAction::surface, .range = {0, 1000},
     .doc = "Aspect ratio of the cuticle's undulations: the exponent of the surface lobe; by default the specimen's.",
     .member = &TissueParams::cuticle_aspect},
    {.name = "epidermisaspect", .action = LeafAction::structure, .range = {0, 100},
     .doc = "Aspect ratio of the epidermal cells' caps; by default the specimen's.",
     .member = &TissueParams::epidermis_aspect, .fit_range = {0.7, 20}, .little = 1},
    {.name = "spongyaspect", .action = LeafAction::structure, .range = {0, 100},
     .doc = "Aspect ratio of the spongy cells' caps; by default the specimen's.",
     .member = &TissueParams::spongy_aspect, .fit_range = {0.7, 20}, .little = 1},
    {.name = "palisadeaspect", .action = LeafAction::structure, .range = {0, 100},
     .doc = "Aspect ratio of the palisade cells' caps, in bifacial leaves; by default the specimen's.",
     .member = &TissueParams::palisade_aspect, .only_bifacial = true, .fit_range = {0.7, 20}, .little = 1},
    {.name = "spongyshare", .action = LeafAction::structure, .range = {0, 1},
     .doc = "Share of the mesophyll's absorption that lies below the air space, in bifacial leaves; by default the "
            "specimen's: 0 in the published model.", .takes_texture = false, .member = &TissueParams::spongy_share,
     .label = "share below the air space", .only_bifacial = true, .fit_range = {1e-4, 0.95}, .little = 0.05},
    // Fitted: an index of the cuticle at 550 nm from 1.10 to 1.66.
    {.name = "cuticlerefractivity", .action = LeafAction::structure, .range = {0.1, 2},
     .doc = "Refractivity (refractive index - 1) of the cuticle, relative to the published one: 0.25 is an effective "
            "index of 1.13 at 550 nm, as of a surface that hardly reflects; by default the specimen's, 1 in the "
            "published model.", .takes_texture = false, .member = &TissueParams::cuticle_refractivity,
     .label = "relative refractivity of the cuticle", .fit_range = {0.2, 1.3}, .little = 1},
    {.name = "fluorescence", .action = LeafAction::emission, .range = {0, 1},
     .doc = "Quantum yield of fluorescence: photons emitted per photon that chlorophyll absorbs, about 0.01 in "
            "sunlight; 0: none (docs/fluorescence.md).", .takes_texture = false,
     .member = &TissueParams::fluorescence},
};
// clang-format on

}  // namespace frond::leaf
