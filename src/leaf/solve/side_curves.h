#pragma once

#include <optional>
#include <span>
#include <vector>

#include "leaf/solve/monotone_cubic.h"
#include "leaf/solve/solver.h"

namespace frond::leaf {

/// Rs, Rd and T of one side of a leaf at one wavelength, between a table's angles: monotone cubics, constant beyond the
/// first and last angle. Exact at the table's angles.
class SideCurves {
 public:
  /// `column`: the shares at `theta_deg`, which ascends in [0, 180]. The abaxial side has the angles from 90 degrees
  /// on; if there are none, both sides are equal.
  SideCurves(const std::vector<double>& theta_deg, std::span<const Shares> column, bool abaxial);

  /// theta_deg in [0, 90] from this side's normal. Absorptance is interpolated like the shares, so that a lossless leaf
  /// stays lossless.
  Shares at(double theta_deg) const;

 private:
  std::optional<MonotoneCubic> surface_, subsurface_, transmitted_, all_;
};

}  // namespace frond::leaf
