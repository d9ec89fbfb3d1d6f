#pragma once

#include "study/compare/comparison.h"

namespace frond::compare {

/// One candidate against an error that is asked for.
struct CandidateCost {
  size_t candidate;
  std::optional<Effort> effort;  ///< nothing: its bias alone may be too large
  bool never;                    ///< its bias is too large, as sure as the effort would be enough
};

/// What every candidate needs to bring the RMS over all channels and pixels down to `rms`, the cheapest first, those
/// of which that is not known, or known to be wrong, last. `z`: how many standard errors larger bias and noise are
/// taken to be.
std::vector<CandidateCost> candidate_costs(const Comparison& comparison, double rms, double z);

/// Standard errors to add so that all bounds of all candidates hold together with 95 % confidence.
double simultaneous_z(const Comparison& comparison);

/// From `rms_from` down to `rms_to` no candidate is cheaper by 5 %.
struct CheapestRange {
  size_t candidate;
  double rms_from, rms_to;
};

/// Which candidate is the cheapest at which error: from what the best makes of one sample down to the smallest RMS that
/// was measured.
std::vector<CheapestRange> cheapest_ranges(const Comparison& comparison);

/// The answer to each `Request::rms`, a line for each, or which candidate to take down to which error.
std::string verdict(const Comparison& comparison);

}  // namespace frond::compare
