#pragma once

#include "study/compare/comparison.h"

namespace frond::compare {

/// Returns bias, noise and time of each candidate for a terminal.
std::string summary_text(const Comparison& comparison);

/// Returns HTML: candidates that meet the requested errors, the paper's Table 2, and its notes.
std::string tables_html(const Comparison& comparison);

}  // namespace frond::compare
