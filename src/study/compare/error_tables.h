#pragma once

#include "study/compare/comparison.h"

namespace frond::compare {

/// The last rungs' errors, over all pixels and over leaves, as HTML: Table 2 of the paper and what it leaves out; of
/// bands also band by band.
std::string error_tables(const Comparison& comparison);

}  // namespace frond::compare
