#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace frond::leaf {

/// File prospect.csv of this folder, which CMake embeds in the library. Lines that begin with # are comments with the
/// source.
extern const std::string_view prospect_csv;

/// Specific absorption of the constituents of PROSPECT-D (Feret et al. 2017) at one wavelength, m^2/kg; water 1/m.
struct ProspectConstants {
  double chlorophyll, carotenoids, anthocyanins, water;
  /// Dry matter without PROSPECT's constant plateau of 0.23 m^2/kg, which holds up to 1200 nm: `other_absorption`
  /// represents it, and so leaves can have more or less of it.
  double dry_matter;
  double brown_pigments;  ///< per unit of PROSPECT's content, which has no dimension
};

/// PROSPECT-D at one wavelength, as published.
struct ProspectNode {
  double nm;
  ProspectConstants specific;  ///< with all dry matter, its plateau included
  double refractive_index;     ///< of a plate
};

/// Returns the rows of the file, one for each nm from 400 to 2500.
std::span<const ProspectNode> prospect_nodes();

/// Returns the constants for the walk's mesophyll: linear between every fifth node, from 400 to 2500 nm. Below, the
/// first value.
ProspectConstants prospect_constants_at(double lambda_nm);

/// Hash of the file, for the keys of caches.
uint64_t prospect_hash();

}  // namespace frond::leaf
