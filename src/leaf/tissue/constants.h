#pragma once

#include <cstdint>
#include <span>

#include "core/spectrum.h"

namespace frond::leaf {

/// Optical constants of a leaf's constituents at one wavelength.
struct Constants {
  double chlorophyll, carotenoids, protein,
      cellulose;  ///< specific absorption, m^2/kg; cellulose's is used for lignin too
  double water;   ///< absorption coefficient, 1/m
  double n_cuticle, n_mesophyll, n_antidermal_wall;  ///< refractive indices
};

/// Wavelengths (nm) in the domain of `constants_at`. Data begin at 400 nm; below, the first value is used.
inline constexpr Interval kConstantsRange_nm{360, 2500};

/// A point of a tabulated spectrum. Wavelengths are multiples of 5 nm, in ascending order (kAbsorptionGrid).
struct SpectrumNode {
  double lambda_nm, value;
};
/// Returns the value at a wavelength: linear between the nodes, the first or the last value beyond them.
double interpolate(std::span<const SpectrumNode> nodes, double lambda_nm);
/// Continues a hash with the nodes, for the keys of caches.
uint64_t hash(std::span<const SpectrumNode> nodes, uint64_t key = 0);

/// Returns the constants: linear between the nodes of figures after Baranoski 2006 (Remote Sensing of Environment
/// 100:335-347) and the data that it publishes: within 0.3 % of the authors' tables, in steps of 5 nm.
Constants constants_at(double lambda_nm);

/// Hash of all figures of the table, for the keys of caches.
uint64_t constants_hash();

}  // namespace frond::leaf
