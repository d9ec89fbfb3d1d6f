#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "core/parallel.h"

namespace frond {

/// Conditions on which check_stop throws, set by the scopes that a thread has entered.
struct StopState {
  const std::stop_token* token = nullptr;
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();

  bool is_requested() const {
    if (token && token->stop_requested()) return true;
    using Clock = std::chrono::steady_clock;
    return deadline != Clock::time_point::max() && Clock::now() >= deadline;
  }
};

/// Returns the conditions of this thread, for callbacks that a library calls in threads of its own. They are valid as
/// long as the scope exists.
StopState current_stop();

/// While it exists, check_stop and the loops of ThreadPool that this thread starts observe a deadline, too. The
/// earliest of nested deadlines counts.
class DeadlineScope {
 public:
  explicit DeadlineScope(std::optional<std::chrono::steady_clock::time_point> deadline);
  ~DeadlineScope();
  DeadlineScope(const DeadlineScope&) = delete;
  DeadlineScope& operator=(const DeadlineScope&) = delete;

 private:
  std::chrono::steady_clock::time_point outer_;
};

/// While it exists, check_stop does not throw in this thread: a stopped job saves its partial result.
class UnstoppableScope {
 public:
  UnstoppableScope();
  ~UnstoppableScope();
  UnstoppableScope(const UnstoppableScope&) = delete;
  UnstoppableScope& operator=(const UnstoppableScope&) = delete;

 private:
  StopState outer_;
};

/// Calls check_stop in one of 1024 calls: for loops whose iterations take microseconds or less.
class StopPoll {
 public:
  void operator()() {
    if (++calls_ % kInterval == 0) check_stop();
  }

 private:
  static constexpr uint32_t kInterval = 1024;
  uint32_t calls_ = 0;
};

}  // namespace frond
