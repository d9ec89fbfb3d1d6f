#include "jobs/job.h"

namespace frond {

// One job, one file, one line here and one in the list below, which has the order of `frond --help`.
extern const JobInfo kRenderJob;
extern const JobInfo kCompareJob;
extern const JobInfo kFitJob;
extern const JobInfo kTableJob;
extern const JobInfo kBrfJob;
extern const JobInfo kSpectrophotometerJob;
extern const JobInfo kGoniophotometerJob;
extern const JobInfo kConformJob;
extern const JobInfo kBenchJob;
extern const JobInfo kExportJob;
extern const JobInfo kSubmitJob;

std::span<const JobInfo* const> all_jobs() {
  static constexpr const JobInfo* kAll[] = {
      &kRenderJob,
      &kCompareJob,
      &kFitJob,
      &kTableJob,
      &kBrfJob,
      &kSpectrophotometerJob,
      &kGoniophotometerJob,
      &kConformJob,
      &kBenchJob,
      &kExportJob,
      &kSubmitJob,
  };
  return kAll;
}

}  // namespace frond
