#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <stop_token>

namespace frond {

/// Ends work whose partial result is useless.
struct Stopped : std::runtime_error {
  Stopped() : std::runtime_error("stopped") {}
};

/// While it exists, check_stop and the loops of ThreadPool that this thread starts observe `token`. Scopes can be
/// nested; the innermost whose token can be stopped counts.
class StopScope {
 public:
  explicit StopScope(std::stop_token token);
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  std::stop_token token_;
  const std::stop_token* outer_;
};

/// Throws Stopped if a stop has been requested by the token of the thread's StopScope. Long loops call it several times
/// a second; it costs a few nanoseconds.
void check_stop();
/// Returns whether check_stop would throw.
bool is_stop_requested();

/// Runs parallel loops on std::jthread, which ThreadSanitizer understands. Threads take indices in no defined order:
/// the result of an iteration must depend on its index alone.
class ThreadPool {
 public:
  /// With 0, one thread for each hardware thread.
  explicit ThreadPool(int threads = 0);

  int size() const { return threads_; }
  /// Calls body(index, worker) for each index in [0, count); `worker`, in [0, size()), identifies the thread. Returns
  /// when all calls have returned. The first exception stops the loop and is rethrown. Calls check_stop for each index;
  /// the bodies can call it too.
  void for_each(int64_t count, const std::function<void(int64_t index, int worker)>& body) const;

 private:
  int threads_;
};

}  // namespace frond
