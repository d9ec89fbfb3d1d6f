#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace frond::leaf {

/// Layers of cells of a leaf (Baranoski 2006; Baranoski and Eng 2007).
enum class Structure : uint8_t {
  bifacial,   ///< palisade cells above, spongy cells below, an air space under both
  unifacial,  ///< one kind of mesophyll on both sides of an air space, whose depth varies from ray to ray
};

/// A pigment that green leaves lack, such as a pigment of petals.
struct Pigment {
  double concentration = 0;                 ///< in the mesophyll, kg/m^3
  std::vector<double> specific_absorption;  ///< m^2/kg, at kAbsorptionGrid
  bool fluoresces = false;                  ///< as chlorophyll does

  friend bool operator==(const Pigment&, const Pigment&) = default;
};

/// Specific absorption of chlorophylls, carotenoids and water.
enum class AbsorptionTables : uint8_t {
  baranoski,  ///< the model's, as published (constants.h)
  prospect,   ///< PROSPECT-D's, calibrated with measured leaves (prospect.h)
};

/// Most rows of the table of a leaf's numbers (leaf_numbers.h).
inline constexpr size_t kMostLeafNumbers = 32;

/// Biological parameters of a leaf: structure and chemistry.
struct TissueParams {
  Structure structure = Structure::bifacial;
  double thickness_m = 0;
  double mesophyll_fraction = 0;  ///< share of the thickness that absorbs, in [0, 1]
  AbsorptionTables absorption_tables = AbsorptionTables::baranoski;
  /// Concentrations of the constituents in the mesophyll, by the place of their rows in kLeafNumbers.
  std::array<double, kMostLeafNumbers> concentrations = {};
  std::vector<Pigment> pigments = {};
  /// Aspect ratios: of the cuticle's undulations and of cell caps. They are the exponents of the lobes.
  double cuticle_aspect = 0, epidermis_aspect = 0, spongy_aspect = 0, palisade_aspect = 0;
  /// Share of the absorption that lies below the air space of a bifacial leaf, in [0, 1]; 0 as published.
  double spongy_share = 0;
  /// Refractivity (index - 1) of the cuticle and epidermis, relative to the published one; above 0.
  double cuticle_refractivity = 1;
  double fluorescence = 0;        ///< photons emitted per photon that a fluorescing constituent absorbs, in [0, 1]
  bool sieve_and_detour = false;  ///< the later form of Beer's law, with cos(cos theta) for cos theta

  /// The number of this name in scene files, which kLeafNumbers must have.
  double& number(std::string_view name);
  double number(std::string_view name) const { return const_cast<TissueParams&>(*this).number(name); }

  friend bool operator==(const TissueParams&, const TissueParams&) = default;
};

}  // namespace frond::leaf
