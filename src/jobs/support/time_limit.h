#pragma once

#include "core/stop.h"
#include "jobs/record/job.h"

namespace frond {

/// Calls `load`, which prepares a measurement, and returns its result. Throws InputError if the time limit ends
/// meanwhile: without a measurement there is no partial result. `control` has its deadline; `where` returns a place in
/// the scene.
template <class Load, class Where>
auto within_time_limit(const JobRun& run, const RenderControl& control, const Load& load, const Where& where) {
  const bool is_limited = run.args.given("time-limit");
  const DeadlineScope limit(is_limited ? control.deadline : std::nullopt);
  try {
    return load();
  } catch (const Stopped&) {
    if (!is_limited || run.control.stop.stop_requested()) throw;
    fail(where(), "{}: the time limit ended before the first sample: preparing the scene takes longer",
         run.args.spelled("time-limit"));
  }
}

/// The last scene file of the arguments, as a place without a line.
inline Location scene_file(const Arguments& args) {
  return {std::make_shared<const std::string>(args.words("scene").back()), 0, 0};
}

}  // namespace frond
