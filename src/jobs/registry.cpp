#include "jobs/record/job.h"

namespace frond {

// Every job has one file, one declaration here, and one entry in the list below, which sets the order of `frond
// --help`.
extern const JobInfo kBenchJob;
extern const JobInfo kBrfJob;
extern const JobInfo kCanopyJob;
extern const JobInfo kCheckJob;
extern const JobInfo kCompareJob;
extern const JobInfo kCompletionJob;
extern const JobInfo kConformJob;
extern const JobInfo kConvertJob;
extern const JobInfo kDescribeJob;
extern const JobInfo kDifferenceJob;
extern const JobInfo kExportJob;
extern const JobInfo kFitJob;
extern const JobInfo kFluxJob;
extern const JobInfo kGoniophotometerJob;
extern const JobInfo kImportJob;
extern const JobInfo kInstancesJob;
extern const JobInfo kListJob;
extern const JobInfo kManJob;
extern const JobInfo kMergeJob;
extern const JobInfo kRenderJob;
extern const JobInfo kSpectrophotometerJob;
extern const JobInfo kStructureJob;
extern const JobInfo kSubmitJob;
extern const JobInfo kSubmitBrfJob;
extern const JobInfo kSubmitFluxJob;
extern const JobInfo kTableJob;

std::span<const JobInfo* const> all_jobs() {
  static constexpr const JobInfo* kAll[] = {
      &kRenderJob,  // Render
      &kCompareJob,
      &kFitJob,
      &kTableJob,  // Leaf models
      &kBrfJob,
      &kFluxJob,
      &kStructureJob,
      &kSpectrophotometerJob,
      &kGoniophotometerJob,  // Measure
      &kListJob,
      &kDescribeJob,
      &kConformJob,
      &kBenchJob,
      &kExportJob,  // Materials
      &kCheckJob,
      &kImportJob,
      &kCanopyJob,
      &kInstancesJob,  // Scenes
      &kConvertJob,
      &kDifferenceJob,  // Images
      &kSubmitJob,
      &kSubmitBrfJob,
      &kSubmitFluxJob,
      &kMergeJob,  // Cluster
      &kManJob,
      &kCompletionJob,  // Shell
  };
  return kAll;
}

}  // namespace frond
