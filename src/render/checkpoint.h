#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "core/log.h"
#include "render/parts/part.h"
#include "render/progress.h"

namespace frond {

/// Error: another process writes the same file; the same call can succeed later.
class Busy : public InputError {
 public:
  explicit Busy(const std::string& message) : InputError({}, message) {}
};

/// Lock on the file of a part: two processes must not overwrite each other's result. The destructor, or the end of the
/// process for any reason, releases it. On file systems without locks it has no effect.
class PartLock {
 public:
  /// Throws Busy if another process holds the lock, InputError if the lock file cannot be written.
  explicit PartLock(const std::filesystem::path& part);
  ~PartLock();
  PartLock(const PartLock&) = delete;
  PartLock& operator=(const PartLock&) = delete;

 private:
  std::filesystem::path path_;
  int descriptor_;
};

/// Writes checkpoints of a part in a separate thread while the part is being rendered. It is passed to the render as
/// Progress and forwards all calls to `next`.
class Checkpointer final : public Progress {
 public:
  /// Writes to `path` every `seconds`. `part` and `log` must outlive the object; the header of `part` is copied. `next`
  /// may be nullptr.
  Checkpointer(std::filesystem::path path, double seconds, const RenderPart& part, Progress* next, const Log& log);
  ~Checkpointer() override;

  void update(double fraction, const RenderStatistics& so_far) override;
  void finish() override;
  /// Calls `change`, which changes the part, between two checkpoints, and copies its header. Thread-safe.
  void change_part(const std::function<void()>& change, const PartHeader& header);
  /// Writes a checkpoint immediately. Throws InputError. A periodic write that fails is reported as a warning and
  /// repeated after the interval. Thread-safe.
  void write();

 private:
  void run(const std::stop_token& stop);

  std::filesystem::path path_;
  double seconds_;
  const Film& film_;
  PartHeader header_;
  Progress* next_;
  const Log& log_;
  std::mutex mutex_, writing_;
  RenderStatistics so_far_;
  std::condition_variable_any ended_;
  std::jthread thread_;  // the last member: it starts after the others are initialized
};

}  // namespace frond
