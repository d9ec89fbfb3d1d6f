#pragma once

#include "cli/compare/comparison.h"

namespace frond::compare {

/// The paper's Table 2 and what it leaves out, as HTML.
std::string tables_html(const Comparison& comparison);

/// Bias, noise and time of each candidate, for a terminal.
std::string summary_text(const Comparison& comparison);

}  // namespace frond::compare
