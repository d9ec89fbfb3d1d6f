#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "leaf/tissue/constants.h"
#include "leaf/tissue/tissue_params.h"

namespace frond::leaf {

/// Even steps of wavelength over all for which the constants stand. Their nodes lie on it: linear interpolation between
/// loses nothing.
struct WavelengthGrid {
  double first_nm, step_nm;
  size_t count;

  constexpr size_t size() const { return count; }
  constexpr double nm(size_t i) const { return first_nm + static_cast<double>(i) * step_nm; }

  struct Cell {
    size_t below;
    double t;  ///< of the way to the next node
  };
  constexpr Cell cell(double lambda_nm) const {
    const double x = std::max(0.0, (lambda_nm - first_nm) / step_nm);
    const size_t below = std::min(static_cast<size_t>(x), count - 2);
    return {below, x - static_cast<double>(below)};
  }
};
inline constexpr WavelengthGrid kAbsorptionGrid{360, 5, 429};
static_assert(kAbsorptionGrid.nm(0) == kConstantsRange_nm.min && kAbsorptionGrid.nm(428) == kConstantsRange_nm.max);

/// Of the mesophyll, 1/m: the sum over pigments, proteins, fibres and water of concentration times specific absorption,
/// and what else absorbs.
double absorption_coefficient(const TissueParams& params, double lambda_nm);

/// The same at every wavelength of kAbsorptionGrid.
std::vector<double> absorption_coefficients(const TissueParams& params);

}  // namespace frond::leaf
