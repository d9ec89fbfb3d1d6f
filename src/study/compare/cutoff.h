#pragma once

#include <functional>

#include "render/render_loop.h"

namespace frond::compare {

/// Rays that wait to be shot at some depth of the tree over all that were shot before, by which the paper ends its
/// trees.
struct UnshotRatio {
  double value = 0;
  double relative_error = 0;  ///< its standard error, of counting
};

/// After so many scattering events, from 1 to PathEnds::kDepths - 1. Between whole numbers the logarithm of the ratio
/// is linear; where no ray is left half a one is taken.
UnshotRatio unshot_ratio(const PathEnds& ends, double events);

/// Where the ratio has fallen to 1e-4, the paper's; from 1 to PathEnds::kDepths - 1.
double depth_of_trees(const PathEnds& ends);

/// The attenuation below which paths end, and what it leaves unshot.
struct CutoffFit {
  double cutoff;
  UnshotRatio left;
  bool equal;  ///< to what was asked for, within a standard error of both
};

inline constexpr double kPaperCutoff = 0.01;

/// Looks for the cutoff that leaves `target`, from the paper's on, in a few steps; `left_by` renders with one. Where
/// none from 1e-6 to 0.5 does the nearest is returned.
CutoffFit fit_cutoff(const UnshotRatio& target, const std::function<UnshotRatio(double cutoff)>& left_by);

}  // namespace frond::compare
