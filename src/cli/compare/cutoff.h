#pragma once

#include <functional>

#include "integrators/render.h"

namespace frond::compare {

/// Rays that wait to be shot after so many scattering events, and all that were shot before them. The paper ends its
/// trees by the ratio of the two.
struct Unshot {
  uint64_t unshot = 0, shot = 0;

  double ratio() const { return double(unshot) / double(shot); }
};

/// `events` from 1 to PathEnds::kDepths - 1.
Unshot unshot_after(const PathEnds& ends, size_t events);

/// The first number of events after which the ratio is below 1e-4, the paper's; PathEnds::kDepths - 1 at most.
size_t depth_of_trees(const PathEnds& ends);

/// The attenuation below which paths end, and what it leaves unshot.
struct CutoffFit {
  double cutoff;
  Unshot rays;
  bool equal;  ///< the ratio is the one asked for, within a standard error of the two counts
};

inline constexpr double kPaperCutoff = 0.01;

/// Looks for the cutoff whose ratio is the target's, from the paper's on, in a few steps; `rays_at` renders with one.
/// Where none from 1e-6 to 0.5 gives it the nearest is returned.
CutoffFit fit_cutoff(const Unshot& target, const std::function<Unshot(double cutoff)>& rays_at);

}  // namespace frond::compare
