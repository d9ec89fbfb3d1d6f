#pragma once

#include <vector>

#include "jobs/record/job.h"

namespace frond {

/// Returns the result of `frond spectrophotometer --fluorescence`: matrices and balances of photons. The job declares
/// material, with, angles, excitation, emission, rays, seed and plot. Throws InputError.
Result fluorescence_result(const JobRun& run);

}  // namespace frond
