#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/units/interval.h"
#include "leaf/fit/fit.h"
#include "leaf/tissue/prospect.h"

namespace frond::leaf {

/// A number of PROSPECT-D as a parameter. Those of constituents follow from the rows of leaf/tissue/leaf_rows.h.
struct PlateNumber {
  std::string_view name;  ///< PROSPECT's
  std::string_view unit;  ///< of its literature
  Interval range;
  std::string doc;
  bool is_needed;                       ///< otherwise 0 by default
  double ProspectConstants::*specific;  ///< absorption of the constituent; nullptr: the number of plates
  double scale;                         ///< from `unit` to the unit of 1 / `specific`
};

/// Returns the numbers: that of plates, and then the contents per leaf area.
std::span<const PlateNumber> plate_numbers();

/// Returns the number of this name; nullptr if there is none.
const PlateNumber* find_plate_number(std::string_view name);

/// Leaf of PROSPECT-D (Jacquemoud and Baret 1990; Feret et al. 2017): a stack of plates that absorb, between which the
/// light is diffuse.
struct PlateLeaf {
  std::vector<double> values;  ///< in the order of plate_numbers()

  double plates() const { return values[0]; }
  bool operator==(const PlateLeaf&) const = default;
};

/// Returns R and T of the leaf at each nm from 400 to 2500, and at 360 nm those at 400 nm; both sides are alike.
/// PROSPECT takes light within 40 degrees of the normal; the measurements have an angle of incidence of 8 degrees.
std::vector<LeafMeasurement> plate_spectra(const PlateLeaf& leaf);

/// Leaf of plates that was fitted to measurements.
struct PlateFit {
  PlateLeaf leaf;
  double rmse;  ///< of the R and T that were measured
};

/// Returns the leaf of plates with the least squares of R and T, without any prior, from several starts. Uses the
/// measurements from 400 nm on, at angles of incidence below 20 degrees on either side, for which PROSPECT is made;
/// R is on_background. nullopt: their values are fewer than the numbers.
std::optional<PlateFit> fit_plates(std::span<const LeafMeasurement> measurements, double background = 0);

/// Leaf of the random walk in place of a leaf of plates.
struct NearestWalk {
  TissueParams params;
  double rmse;     ///< of R and T
  double largest;  ///< difference of R or T, at
  double largest_nm;
};

/// Returns the leaf whose solved walk has the nearest R and T, by `fit_leaf` at every 10 nm. Leaves are fitted once in
/// a process. Thread-safe.
const NearestWalk& nearest_walk(const PlateLeaf& leaf);

}  // namespace frond::leaf
