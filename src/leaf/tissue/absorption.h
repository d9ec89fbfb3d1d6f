#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "leaf/tissue/constants.h"
#include "leaf/tissue/leaf_numbers.h"

namespace frond::leaf {

/// Grid of wavelengths, even over the whole range of the constants. The constants' nodes lie on it, so linear
/// interpolation between its nodes is exact.
struct WavelengthGrid {
  double first_nm, step_nm;
  size_t count;

  /// Number of nodes.
  constexpr size_t size() const { return count; }
  /// Wavelength of node i, nm.
  constexpr double nm(size_t i) const { return first_nm + static_cast<double>(i) * step_nm; }

  /// Position of a wavelength on the grid.
  struct Cell {
    size_t below;
    double t;  ///< fraction of the distance to the next node; above 1 beyond the last one
  };
  /// Returns the cell that contains a wavelength (nm); the first cell for shorter ones.
  constexpr Cell cell(double lambda_nm) const {
    const double x = std::max(0.0, (lambda_nm - first_nm) / step_nm);
    const size_t below = std::min(static_cast<size_t>(x), count - 2);
    return {below, x - static_cast<double>(below)};
  }
};
inline constexpr WavelengthGrid kAbsorptionGrid{360, 5, 429};
static_assert(kAbsorptionGrid.nm(0) == kConstantsRange_nm.min && kAbsorptionGrid.nm(428) == kConstantsRange_nm.max);

/// A constituent and those that absorb like it.
struct Absorber {
  std::vector<const LeafNumber*> numbers;

  const LeafNumber& first() const { return *numbers.front(); }
  /// Amount of all in a leaf, in the unit of the numbers.
  double amount(const TissueParams& p) const {
    double sum = 0;
    for (const LeafNumber* n : numbers) sum += n->value(p);
    return sum;
  }
};
/// All absorbers, in the order of kLeafNumbers.
const std::vector<Absorber>& absorbers();

/// Returns the absorption of 1 of a constituent's unit, m^2/kg for a concentration, at a wavelength within
/// kConstantsRange_nm.
double specific_absorption(const LeafNumber& number, AbsorptionTables tables, double lambda_nm);

/// Returns the absorption coefficient of the mesophyll, 1/m: the sum over all absorbers (kLeafNumbers, pigments) of
/// concentration times specific absorption.
double absorption_coefficient(const TissueParams& params, double lambda_nm);

/// Returns the share of that coefficient that is of constituents whose absorption excites fluorescence; 0 where nothing
/// absorbs.
double fluorescing_share(const TissueParams& params, double lambda_nm);

/// The absorption coefficient at every wavelength of kAbsorptionGrid.
std::vector<double> absorption_coefficients(const TissueParams& params);

}  // namespace frond::leaf
