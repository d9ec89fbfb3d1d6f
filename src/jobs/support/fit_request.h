#pragma once

#include "core/error.h"
#include "jobs/record/job.h"
#include "leaf/fit/fit.h"

namespace frond {

/// Builds the request of the job fit, without measurements, from its options. Throws InputError for parameters that do
/// not exist, contradict each other or are given twice.
leaf::FitRequest fit_request(const Arguments& args);

/// Throws InputError at `where` if there are fewer values than free parameters and no prior.
void check_values(const Arguments& args, const leaf::FitRequest& request, const Location& where);

}  // namespace frond
