#pragma once

#include "study/compare/comparison.h"

namespace frond::compare {

/// Cost of one candidate for a requested error.
struct CandidateCost {
  size_t candidate;
  std::optional<Effort> effort;  ///< empty: not shown to be possible, because of its bias
  bool never;                    ///< the bias is too large, with the same confidence
};

/// Returns the effort of every candidate to reach `rms` over all channels and pixels, cheapest first; candidates whose
/// effort is unknown or that cannot reach it are last. Bias and noise are increased by `z` standard errors.
std::vector<CandidateCost> candidate_costs(const Comparison& comparison, double rms, double z);

/// Returns the number of standard errors at which all bounds of all candidates hold with 95 % joint confidence.
double simultaneous_z(const Comparison& comparison);

/// Range of errors in which no other candidate is more than 5 % cheaper.
struct CheapestRange {
  size_t candidate;
  double rms_from, rms_to;
};

/// Returns the cheapest candidates by error, from the best error after one sample down to the smallest measured RMS.
std::vector<CheapestRange> cheapest_ranges(const Comparison& comparison);

/// Returns one line for each `Request::rms`, or without requests the cheapest candidates by error.
std::string verdict(const Comparison& comparison);

}  // namespace frond::compare
