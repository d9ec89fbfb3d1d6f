#pragma once

#include <cstdint>

#include "core/spectrum.h"

namespace frond::leaf {

/// What leaves are made of, optically, at one wavelength.
struct Constants {
  double chlorophyll, carotenoids, protein,
      cellulose;                                     ///< specific absorption, m^2/kg; cellulose stands for lignin too
  double water;                                      ///< absorption coefficient, 1/m
  double n_cuticle, n_mesophyll, n_antidermal_wall;  ///< refractive indices
};

/// Wavelengths (nm) for which `constants_at` stands. Data begin at 400 nm; below, the first value holds.
inline constexpr Interval kConstantsRange_nm{360, 2500};

/// Linear between the nodes of figures after Baranoski 2006 (Remote Sensing of Environment 100:335-347) and the data
/// that it publishes: within 0.3 % of the authors' tables, in steps of 5 nm.
Constants constants_at(double lambda_nm);

/// Changes with any figure of the table.
uint64_t constants_hash();

}  // namespace frond::leaf
