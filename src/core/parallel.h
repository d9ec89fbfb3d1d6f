#pragma once

#include <cstdint>
#include <functional>

namespace frond {

/// Runs loops on std::jthread, which ThreadSanitizer sees through. Which thread takes which index is not defined, so
/// results must depend on the index alone.
class ThreadPool {
 public:
  /// 0: one thread for each hardware thread.
  explicit ThreadPool(int threads = 0);

  int size() const { return threads_; }
  /// Calls body(index, worker) for each index in [0, count), worker in [0, size()). Returns when all are done; the
  /// first exception of a body stops the loop and is thrown here.
  void for_each(int64_t count, const std::function<void(int64_t index, int worker)>& body) const;

 private:
  int threads_;
};

}  // namespace frond
