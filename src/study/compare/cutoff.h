#pragma once

#include <functional>

#include "render/render_loop.h"

namespace frond::compare {

/// Ratio of unshot rays (pending at a depth of the tree) to rays shot before. The paper ends its trees by this ratio.
struct UnshotRatio {
  double value = 0;
  double relative_error = 0;  ///< standard error from counting, relative
};

/// Returns the ratio after `events` scattering events, 1 to PathEnds::kDepths - 1. Its logarithm is interpolated
/// linearly between whole numbers; if no ray is left, half a ray is assumed.
UnshotRatio unshot_ratio(const PathEnds& ends, double events);

/// Returns the depth at which the ratio reaches the paper's 1e-4; 1 to PathEnds::kDepths - 1.
double depth_of_trees(const PathEnds& ends);

/// A cutoff of attenuation, below which paths end, and the ratio that it leaves unshot.
struct CutoffFit {
  double cutoff;
  UnshotRatio left;
  bool equal;  ///< `left` equals the target within a standard error of both
};

inline constexpr double kPaperCutoff = 0.01;

/// Searches for the cutoff that leaves `target`, in a few steps from the paper's cutoff. `left_by` renders with a
/// cutoff. If none from 1e-6 to 0.5 matches, returns the nearest.
CutoffFit fit_cutoff(const UnshotRatio& target, const std::function<UnshotRatio(double cutoff)>& left_by);

}  // namespace frond::compare
