#pragma once

#include <cstdint>
#include <functional>

namespace frond {

/// Runs parallel loops on std::jthread, which ThreadSanitizer understands. Threads take indices in no defined order:
/// the result of an iteration must depend on its index alone.
class ThreadPool {
 public:
  /// With 0, one thread for each hardware thread.
  explicit ThreadPool(int threads = 0);

  int size() const { return threads_; }
  /// Calls body(index, worker) for each index in [0, count); `worker`, in [0, size()), identifies the thread. Returns
  /// when all calls have returned. The first exception stops the loop and is rethrown.
  void for_each(int64_t count, const std::function<void(int64_t index, int worker)>& body) const;

 private:
  int threads_;
};

}  // namespace frond
