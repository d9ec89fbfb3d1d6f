#pragma once

#include "study/compare/comparison.h"

namespace frond::compare {

/// A row for each candidate, rung, region and channel; what columns mean stands in comments at the head.
std::string comparison_csv(const Comparison& comparison);

/// The same with everything else that was measured and chosen.
std::string comparison_json(const Comparison& comparison);

}  // namespace frond::compare
