#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "core/stop.h"

namespace frond {
namespace {

thread_local StopState current;

/// Lets a thread of a loop observe what the thread that started the loop observes.
class SharedStop {
 public:
  explicit SharedStop(const StopState& stop) : outer_(std::exchange(current, stop)) {}
  ~SharedStop() { current = outer_; }
  SharedStop(const SharedStop&) = delete;
  SharedStop& operator=(const SharedStop&) = delete;

 private:
  StopState outer_;
};

}  // namespace

StopState current_stop() { return current; }

StopScope::StopScope(std::stop_token token) : token_(std::move(token)), outer_(current.token) {
  if (token_.stop_possible()) current.token = &token_;
}

StopScope::~StopScope() { current.token = outer_; }

DeadlineScope::DeadlineScope(std::optional<std::chrono::steady_clock::time_point> deadline) : outer_(current.deadline) {
  if (deadline) current.deadline = std::min(outer_, *deadline);
}

DeadlineScope::~DeadlineScope() { current.deadline = outer_; }

UnstoppableScope::UnstoppableScope() : outer_(std::exchange(current, {})) {}

UnstoppableScope::~UnstoppableScope() { current = outer_; }

bool is_stop_requested() { return current.is_requested(); }

void check_stop() {
  if (is_stop_requested()) throw Stopped();
}

ThreadPool::ThreadPool(int threads)
    : threads_(threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {}

void ThreadPool::for_each(int64_t count, const std::function<void(int64_t, int)>& body) const {
  std::atomic<int64_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  const StopState stop = current;
  const auto work = [&](int worker) {
    const SharedStop shared(stop);
    try {
      for (int64_t i; (i = next.fetch_add(1)) < count;) {
        check_stop();
        body(i, worker);
      }
    } catch (const std::exception&) {
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
      next = count;
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!error)
        error = std::make_exception_ptr(std::runtime_error("a plug-in threw an object that is no std::exception"));
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
