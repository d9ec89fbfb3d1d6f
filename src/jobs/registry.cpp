#include "jobs/job.h"

namespace frond {

// One job, one file, one line here and one in the list below, which has the order of `frond --help`.
extern const JobInfo kRenderJob;
extern const JobInfo kCompareJob;
extern const JobInfo kBrfJob;
extern const JobInfo kSubmitJob;

std::span<const JobInfo* const> all_jobs() {
  static constexpr const JobInfo* kAll[] = {&kRenderJob, &kCompareJob, &kBrfJob, &kSubmitJob};
  return kAll;
}

}  // namespace frond
