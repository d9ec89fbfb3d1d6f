#pragma once

#include "render/progress.h"
#include "study/compare/comparison.h"
#include "study/compare/study.h"

namespace frond::compare {

struct Plan {
  Candidate reference;
  std::vector<Candidate> candidates;
  /// The ladder is 1, 2, 4 ... and this; of bands, from where a pixel has seen all of them.
  uint64_t top_samples = 256;
  uint64_t reference_samples = 2048;  ///< of each of its two renders
  Progress* progress = nullptr;       ///< may be nullptr
};

/// Renders the reference, then every candidate up the ladder, run by run so that whatever else the machine does falls
/// on all alike. Throws InputError, before anything is rendered, for a candidate that the scene cannot take.
Comparison measure(const Study& study, const Plan& plan, const Request& request);

}  // namespace frond::compare
