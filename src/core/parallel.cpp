#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace frond {

ThreadPool::ThreadPool(int threads)
    : threads_(threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {}

void ThreadPool::for_each(int64_t count, const std::function<void(int64_t, int)>& body) const {
  std::atomic<int64_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  const auto work = [&](int worker) {
    try {
      for (int64_t i; (i = next.fetch_add(1)) < count;) body(i, worker);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> helpers;
    try {
      for (int worker = 1; worker < threads_ && worker < count; ++worker) helpers.emplace_back(work, worker);
    } catch (const std::system_error&) {
      // The system refuses more threads: the existing ones do the work.
    }
    work(0);
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace frond
