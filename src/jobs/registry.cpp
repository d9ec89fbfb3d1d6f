#include "jobs/job.h"

namespace frond {

// One job, one file, one line here and one in the list below.
extern const JobInfo kBrfJob;
extern const JobInfo kCanopyJob;
extern const JobInfo kCheckJob;
extern const JobInfo kCompletionJob;
extern const JobInfo kConvertJob;
extern const JobInfo kDescribeJob;
extern const JobInfo kDifferenceJob;
extern const JobInfo kFluxJob;
extern const JobInfo kInstancesJob;
extern const JobInfo kListJob;
extern const JobInfo kManJob;
extern const JobInfo kMergeJob;

std::span<const JobInfo* const> all_jobs() {
  // In the order of frond --help.
  static constexpr const JobInfo* kAll[] = {
      // Render
      // Leaf models
      // Measure
      &kBrfJob,
      &kFluxJob,
      // Materials
      &kListJob,
      &kDescribeJob,
      // Scenes
      &kCheckJob,
      &kCanopyJob,
      &kInstancesJob,
      // Images
      &kConvertJob,
      &kDifferenceJob,
      // Cluster
      &kMergeJob,
      // Shell
      &kManJob,
      &kCompletionJob,
  };
  return kAll;
}

}  // namespace frond
