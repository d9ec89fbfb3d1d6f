#pragma once

#include <vector>

#include "instruments/errors/statistics.h"
#include "leaf/solve/solver.h"
#include "leaf/walk/walk.h"
#include "tests/stability/comparison.h"

namespace frond::stability {

/// Shares of the light from one angle, each with its error.
struct MeasuredShares {
  Moments surface = {}, subsurface = {}, transmitted = {}, all = {};

  void add(leaf::Fate fate, double weight);
};

/// Unit vector toward the light. At 90 degrees, rounding puts it slightly above the horizon.
Vec3d toward(double theta_deg);

MeasuredShares walk_many(const leaf::Tissue& tissue, double theta_deg, leaf::Absorption absorption, int rays);
MeasuredShares walk_many_in_batch(const leaf::Tissue& tissue, double theta_deg, leaf::Absorption absorption, int rays);

/// Angles of incidence and the true shares at one wavelength.
struct Lit {
  std::vector<double> theta_deg;
  std::vector<leaf::Shares> truth;
};

/// Shares by the solver with twice its nodes.
Lit solved_finely(const leaf::Tissue& tissue, const std::vector<double>& theta_deg);

void add_shares(Comparison& comparison, const MeasuredShares& measured, const leaf::Shares& truth);
void add_shares(Comparison& comparison, const leaf::Shares& value, const leaf::Shares& truth);

/// Adds the cells of the methods that use a tissue: walks and the solver.
void compare_tissue_methods(Row& row, const leaf::Tissue& tissue, const Lit& lit, double solver_bound);

}  // namespace frond::stability
