#pragma once

#include "core/stop.h"
#include "jobs/record/job.h"

namespace frond {

/// Calls `load`, which prepares a measurement, and returns its result. Throws InputError if the deadline of `control`
/// passes meanwhile: without a measurement there is no partial result. `where` returns a place in the scene.
template <class Load, class Where>
auto within_time_limit(const JobRun& run, const RenderControl& control, const Load& load, const Where& where) {
  const DeadlineScope limit(control.deadline);
  try {
    return load();
  } catch (const Stopped&) {
    if (!control.deadline || run.control.stop.stop_requested()) throw;
    fail(where(), "{}: the time limit ended before the first sample: preparing the scene takes longer",
         run.args.spelled("time-limit"));
  }
}

/// The last scene file of the arguments, as a place without a line.
inline Location scene_file(const Arguments& args) {
  return {std::make_shared<const std::string>(args.texts("scene").back()), 0, 0};
}

}  // namespace frond
