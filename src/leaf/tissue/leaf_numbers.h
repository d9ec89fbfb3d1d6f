#pragma once

#include <cassert>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/spectrum.h"
#include "core/units/quantity.h"
#include "leaf/tissue/area_content.h"
#include "leaf/tissue/constants.h"
#include "leaf/tissue/prospect.h"
#include "leaf/tissue/tissue_params.h"

namespace frond::leaf {

/// How a number of a leaf acts on light.
enum class LeafAction : uint8_t {
  length,      ///< extent of the mesophyll: a factor of its optical depth
  absorption,  ///< of a constituent of the mesophyll, in proportion to the number
  structure,   ///< of layers and walls: how much light is reflected and transmitted, and where
  surface,     ///< shape of the reflection at the surface, but not its share
  emission,    ///< light at other wavelengths than the absorbed one; reflectance and transmittance are unchanged
};

inline constexpr std::string_view kMassPerVolume = "kg/m^3";

/// A number of a leaf. Parameters of materials, textures, keys of caches, heads of tables, variables of fits and their
/// reports, the Python module and exports follow from its row in kLeafNumbers.
struct LeafNumber {
  std::string_view name;  ///< in scene files
  LeafAction action;
  std::string_view unit = "";  ///< of the member and of scene files
  Interval range = {};         ///< in scene files
  std::string_view doc = "";   ///< one line of documentation; empty: no parameter, all leaves have 1 of it
  bool takes_texture = true;
  PhysicalQuantity quantity = PhysicalQuantity::other;
  double TissueParams::*member = nullptr;  ///< nullptr: in TissueParams::concentrations
  std::string_view label = "";             ///< in heads of tables; empty: the name
  bool only_bifacial = false;              ///< without effect in unifacial leaves

  // Of constituents: the specific absorption, by one of these; with none of them the absorption coefficient is the
  // number itself, at every wavelength. With `published` and `prospect`, the leaf's absorption tables select.
  double Constants::*published = nullptr;
  double ProspectConstants::*prospect = nullptr;
  std::span<const SpectrumNode> spectrum = {};
  bool fluoresces = false;  ///< the light that it absorbs excites fluorescence
  /// Name of the constituent that absorbs alike. A fit keeps the ratio of both.
  std::string_view follows = "";
  AreaContent content = {};

  // Of numbers that `fit_leaf` can estimate.
  Interval fit_range = {};                         ///< of the search; {0, 0}: not estimated
  double little = 0;                               ///< start of the search where the specimen has none
  std::optional<AbsorptionTables> only_with = {};  ///< with these tables alone; with others a leaf has none

  constexpr bool is_parameter() const { return !doc.empty(); }
  constexpr bool is_fitted() const { return fit_range.max > 0; }
  constexpr bool is_structure() const { return action == LeafAction::structure; }
  /// Whether reflectance and transmittance depend on the number.
  constexpr bool changes_shares() const { return action != LeafAction::surface && action != LeafAction::emission; }
  constexpr bool absorbs() const { return action == LeafAction::absorption; }
  constexpr bool acts_by_depth() const { return absorbs() || action == LeafAction::length; }
  /// Whether only PROSPECT-D has the constituent.
  constexpr bool is_of_prospect() const { return prospect && !published; }

  /// Returns the number of a leaf. This must be an element of kLeafNumbers.
  double& value(TissueParams& p) const;
  double value(const TissueParams& p) const { return is_parameter() ? value(const_cast<TissueParams&>(p)) : 1; }
};

/// All numbers of a leaf, in the order of parameters, variables of fits and reports.
extern const std::span<const LeafNumber> kLeafNumbers;

inline double& LeafNumber::value(TissueParams& p) const {
  assert(this >= kLeafNumbers.data() && this < kLeafNumbers.data() + kLeafNumbers.size());  // no copy
  return member ? p.*member : p.concentrations[static_cast<size_t>(this - kLeafNumbers.data())];
}

/// The numbers that leaf materials have as parameters.
inline auto leaf_parameters() { return kLeafNumbers | std::views::filter(&LeafNumber::is_parameter); }

/// Returns the number of this name; nullptr if there is none.
const LeafNumber* find_leaf_number(std::string_view name);

/// The contents per leaf area that constituents belong to, in the order of reports.
const std::vector<AreaContent>& area_contents();
/// The parameters that are of this content.
std::vector<const LeafNumber*> parts_of(const AreaContent& content);
/// Returns a content of a leaf, kg/m^2.
double area_content(const TissueParams& p, const AreaContent& content);

/// Returns all that a leaf's optics depend on, as comments at the head of a table's file: a part of the keys of caches.
std::string describe(const TissueParams& params);

}  // namespace frond::leaf
