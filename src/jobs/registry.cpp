#include "jobs/job.h"

namespace frond {

// One job, one file, one line here and one in the list below.
extern const JobInfo kBrfJob;
extern const JobInfo kSpectrophotometerJob;
extern const JobInfo kGoniophotometerJob;
extern const JobInfo kConformJob;
extern const JobInfo kBenchJob;
extern const JobInfo kExportJob;
extern const JobInfo kTableJob;
extern const JobInfo kFitJob;

std::span<const JobInfo* const> all_jobs() {
  static constexpr const JobInfo* kAll[] = {
      &kBrfJob,
      &kSpectrophotometerJob,
      &kGoniophotometerJob,
      &kConformJob,
      &kBenchJob,
      &kExportJob,
      &kTableJob,
      &kFitJob,
  };
  return kAll;
}

}  // namespace frond
