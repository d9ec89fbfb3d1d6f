#pragma once

#include "study/compare/comparison.h"

namespace frond::compare {

/// A gnuplot script: bias with 95 % intervals, and noise of one render after the last rung, against the bands'
/// wavelengths, over all pixels. Empty where no band has any. For comparisons of bands.
std::string bands_chart(const Comparison& comparison);

}  // namespace frond::compare
