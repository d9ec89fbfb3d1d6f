#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>

#include "core/log.h"
#include "jobs/record/arguments.h"
#include "render/checkpoint.h"

namespace frond {

/// The file in which a job keeps its partial result, and from which it resumes. It is locked while this object lives.
class KeptFile {
 public:
  struct Names {
    std::filesystem::path finished;    ///< what is complete
    std::filesystem::path checkpoint;  ///< what is not; may be the same
  };

  /// Throws Busy.
  KeptFile(Names names, std::stop_token stop, const Log& log)
      : names_(std::move(names)), stop_(std::move(stop)), log_(log), lock_(names_.finished) {}

  /// The partial result of an earlier run. Throws InputError where there is one and `resume` is false.
  std::optional<std::filesystem::path> found(bool resume) const;
  bool was_stopped() const { return stop_.stop_requested(); }
  const std::filesystem::path& checkpoint() const { return names_.checkpoint; }
  /// Keeps the result so far, by `write`, which gets the path. A write of a complete result that fails is a warning,
  /// unless the file is the result itself.
  void keep(bool is_complete, bool is_result, const std::function<void(const std::filesystem::path&)>& write) const;
  /// Logs where the partial result of a stopped job is, and how to resume it.
  void report_stop() const;

 private:
  Names names_;
  std::stop_token stop_;
  const Log& log_;
  PartLock lock_;
};

/// From one checkpoint to the next: "checkpoint", or 60.
double checkpoint_seconds(const Arguments& args);

}  // namespace frond
