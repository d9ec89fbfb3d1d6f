#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "core/log.h"
#include "render/parts/part.h"
#include "render/progress.h"

namespace frond {

/// Another program is at work on the same thing: what is refused now may be done later.
class Busy : public InputError {
 public:
  explicit Busy(const std::string& message) : InputError({}, message) {}
};

/// Refuses, by Busy, that two programs work on one part: each would undo what the other has written. Holds for as
/// long as it lives, or until the program ends, however it does.
class PartLock {
 public:
  explicit PartLock(const std::filesystem::path& part);
  ~PartLock();
  PartLock(const PartLock&) = delete;
  PartLock& operator=(const PartLock&) = delete;

 private:
  std::filesystem::path path_;
  int descriptor_;
};

/// Writes a part from time to time while it is being rendered, by a thread of its own. Is the render's Progress, and
/// passes on what it receives.
class Checkpointer final : public Progress {
 public:
  /// `part` and `log` must outlive it; of its header a copy is kept. `next` may be nullptr.
  Checkpointer(std::filesystem::path path, double seconds, const RenderPart& part, Progress* next, const Log& log);
  ~Checkpointer() override;

  void update(double fraction, const RenderStatistics& so_far) override;
  void finish() override;
  /// In place of the copy.
  void set_header(const PartHeader& header);
  /// Now. Throws InputError; a write by the clock that fails is a warning, and tried again.
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
  std::jthread thread_;  // last: it begins when all else is there
};

}  // namespace frond
