#pragma once

#include "study/compare/comparison.h"

namespace frond::compare {

/// Bias, noise and time of each candidate, for a terminal.
std::string summary_text(const Comparison& comparison);

}  // namespace frond::compare
