#pragma once

#include "tests/stability/specimen.h"

namespace frond::stability {

/// Compares pi f of `leaf_solved` between directions at the angles `theta_deg` on both sides, at four azimuths, with
/// the Fourier series solved at these angles with twice the nodes.
Cell compare_solved_f(Specimen& specimen, const leaf::Tissue& tissue, const std::vector<double>& theta_deg,
                      double bound);

}  // namespace frond::stability
