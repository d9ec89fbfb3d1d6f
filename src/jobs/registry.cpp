#include "jobs/job.h"

namespace frond {

// One job, one file, one line here and one in the list below.
extern const JobInfo kBrfJob;

std::span<const JobInfo* const> all_jobs() {
  static constexpr const JobInfo* kAll[] = {&kBrfJob};
  return kAll;
}

}  // namespace frond
