#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>

#include "core/log.h"
#include "jobs/record/arguments.h"
#include "render/checkpoint.h"
#include "system/file_uses.h"

namespace frond {

/// The file in which a job keeps its partial result, and from which it resumes. It is locked during the lifetime of
/// this object.
class ResumeFile {
 public:
  struct Names {
    std::filesystem::path finished;    ///< path of a complete result
    std::filesystem::path checkpoint;  ///< path of a partial result; may equal `finished`
  };

  /// Throws Busy if another process holds the lock, InputError if the checkpoint is another file of the job.
  ResumeFile(Names names, std::stop_token stop, const Log& log);

  /// Returns the path of an earlier run's result, or nullopt. Throws InputError if there is one and `resume` is false.
  std::optional<std::filesystem::path> found(bool resume) const;
  bool was_stopped() const { return stop_.stop_requested(); }
  const std::filesystem::path& checkpoint() const { return names_.checkpoint; }
  /// Calls `write` with the path for the result so far. A failure to write a complete result is a warning, unless the
  /// file is the result itself (`is_result`).
  void keep(bool is_complete, bool is_result, const std::function<void(const std::filesystem::path&)>& write) const;
  /// Logs the path of a stopped job's partial result, and how to resume it.
  void report_stop() const;

 private:
  Names names_;
  std::stop_token stop_;
  const Log& log_;
  PlannedOutput output_, lock_output_;
  PartLock lock_;
};

/// Returns the interval between checkpoints in s: parameter "checkpoint", or 60.
double checkpoint_seconds(const Arguments& args);

}  // namespace frond
