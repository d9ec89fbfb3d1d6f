#pragma once

#include "tests/stability/specimen.h"

namespace frond::stability {

/// pi f of `leaf_solved` between directions at the angles of `theta_deg` on both sides, at four azimuths, each against
/// the series of its azimuth solved at these very angles with twice the nodes.
Cell compare_solved_f(Specimen& specimen, const leaf::Tissue& tissue, const std::vector<double>& theta_deg,
                      double bound);

}  // namespace frond::stability
