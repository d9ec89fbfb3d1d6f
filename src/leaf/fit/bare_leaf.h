#pragma once

#include <memory>

#include "leaf/solve/quadrature.h"
#include "leaf/tissue/tissue.h"

namespace frond::leaf {

/// Nodes for the R and T that fits report: an error of 1e-4.
inline constexpr NodeRule kFitNodes{.nodes = 4};

/// The tissue of one leaf for solvers, which need the exponents of its lobes but neither the tables for random numbers
/// nor the absorption of a TissueModel, and are made a hundred times as fast. Must outlive the tissues that it makes.
class BareLeaf {
 public:
  /// Uses the structure, the aspect ratios, the share below the air space, the cuticle and the sieve effect.
  explicit BareLeaf(const TissueParams& params);

  /// Returns the leaf at a wavelength within kConstantsRange_nm with this optical depth of the mesophyll.
  Tissue at(double lambda_nm, double optical_depth) const;

 private:
  struct Lobes {
    Lobe cuticle, epidermis, spongy, palisade;
    InterfaceLobes at_interfaces{};
  };
  const TissueModel& plain_;  ///< of the same structure, with the published cuticle
  double spongy_share_, refractivity_;
  bool sieve_;
  std::unique_ptr<Lobes> lobes_;
};

}  // namespace frond::leaf
