#pragma once

#include "render/progress.h"
#include "study/compare/comparison.h"
#include "study/compare/study.h"

namespace frond::compare {

/// The measurements of a comparison.
struct Plan {
  Candidate reference;
  std::vector<Candidate> candidates;
  /// Candidates are measured after 1, 2, 4, ... and this number of samples per pixel; bands start where every band is
  /// sampled.
  uint64_t top_samples = 256;
  uint64_t reference_samples = 2048;  ///< per pixel of each of the reference's two renders
  Progress* progress = nullptr;       ///< may be nullptr
};

/// Renders the reference, then every candidate at rising numbers of samples. Candidates are interleaved, so that other
/// load on the machine affects all alike. Throws InputError, before rendering, for a candidate that the scene does not
/// support.
Comparison measure(const Study& study, const Plan& plan, const Request& request);

}  // namespace frond::compare
