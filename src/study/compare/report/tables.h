#pragma once

#include "study/compare/comparison.h"

namespace frond::compare {

/// Bias, noise and time of each candidate, for a terminal.
std::string summary_text(const Comparison& comparison);

/// As HTML: what meets the errors asked for, the paper's Table 2, and what that leaves out.
std::string tables_html(const Comparison& comparison);

}  // namespace frond::compare
