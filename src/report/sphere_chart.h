#pragma once

#include <string>

#include "instruments/conformance.h"

namespace frond {

/// Script for gnuplot that draws a finding's map: both hemispheres of wi in equal-area projection, each patch in the
/// colour of found / expected, or of found where there is nothing to compare with. Needs `finding.map`.
std::string sphere_chart(const Finding& finding);

}  // namespace frond
