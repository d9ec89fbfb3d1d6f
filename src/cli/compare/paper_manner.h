#pragma once

#include <optional>

#include "cli/compare/study.h"

namespace frond::compare {

/// The candidate as Baranoski and Rokne render: light sampling does not see a surface lobe, and a path ends when the
/// luminance of its attenuation falls below 0.01. Nothing where the scene's integrator has no such end.
std::optional<Candidate> in_the_papers_manner(const Candidate& candidate, const Study& study);

}  // namespace frond::compare
