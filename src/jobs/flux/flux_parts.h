#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "jobs/record/job.h"
#include "jobs/support/resume_file.h"
#include "radiometry/flux.h"
#include "render/film/work.h"

namespace frond {

/// Files with sums of the job flux: checkpoints, the part that --part writes, and those of --merge. A run measures one
/// scene, or with --times several, one after the other.
class FluxParts {
 public:
  /// Reads the files. `run` must outlive this object. Throws InputError.
  explicit FluxParts(const JobRun& run);

  bool writes_part() const { return run_.args.given("part"); }
  bool merges() const { return !merged_.empty(); }
  /// Prepares the measurement of the next scene's paths; adds those of an earlier run.
  void begin(FluxMeter& meter, SampleRange paths);
  /// Returns a callback that writes a checkpoint if the last one is older than the interval; empty: there is none.
  std::function<void()> checkpoint(const FluxMeter& meter);
  /// Keeps the sums of the scene, if there is a file for them.
  void end(const FluxMeter& meter);
  /// Writes the checkpoint or the part. Returns a result without tables.
  Result finish(bool is_complete);
  /// Adds all parts of the next scene, which together have this number of paths. Throws InputError for a part that is
  /// missing, of another measurement, or given twice.
  void merge(FluxMeter& meter, uint64_t paths);

 private:
  const JobRun& run_;
  std::optional<ResumeFile> file_;
  std::string found_name_;
  std::vector<SumsPart> found_, scenes_;                               ///< of an earlier run; of this one
  std::vector<std::pair<std::string, std::vector<SumsPart>>> merged_;  ///< with the names of their files
  size_t next_ = 0;                                                    ///< number of scenes that were merged
};

}  // namespace frond
