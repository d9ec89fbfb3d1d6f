#include "core/parallel.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace frond {
namespace {

TEST(ThreadPool, CallsEachIndexOnce) {
  for (const int threads : {1, 2, 7}) {
    std::vector<std::atomic<int>> calls(1000);
    ThreadPool(threads).for_each(1000, [&](int64_t i, int) { ++calls[static_cast<size_t>(i)]; });
    for (const auto& count : calls) EXPECT_EQ(count, 1);
  }
}

TEST(ThreadPool, WorkersStayBelowItsSize) {
  const ThreadPool pool(3);
  std::atomic<bool> inside{true};
  pool.for_each(100, [&](int64_t, int worker) {
    if (worker < 0 || worker >= pool.size()) inside = false;
  });
  EXPECT_TRUE(inside);
}

TEST(ThreadPool, NothingToDoCallsNothing) {
  ThreadPool(2).for_each(0, [](int64_t, int) { FAIL(); });
}

TEST(ThreadPool, ThrowsWhatABodyThrowsAndStops) {
  std::atomic<int64_t> calls{0};
  const auto body = [&](int64_t i, int) {
    ++calls;
    if (i == 10) throw std::runtime_error("ten");
  };
  EXPECT_THROW(ThreadPool(1).for_each(1'000'000, body), std::runtime_error);
  EXPECT_EQ(calls, 11);
  EXPECT_THROW(ThreadPool(4).for_each(1'000'000, body), std::runtime_error);
}

TEST(ThreadPool, ZeroMeansTheMachinesThreads) { EXPECT_GE(ThreadPool().size(), 1); }

TEST(ThreadPool, WorksWithFewerThreadsThanAsked) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need more addresses than the limit leaves";
#endif
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  const rlimit little{rlim_t{2} << 30, before.rlim_max};  // for the stacks of some hundreds
  setrlimit(RLIMIT_AS, &little);
  std::atomic<int64_t> sum{0};
  ThreadPool(5000).for_each(5000, [&](int64_t i, int) { sum += i; });
  setrlimit(RLIMIT_AS, &before);
  EXPECT_EQ(sum, 5000 * 4999 / 2);
}

}  // namespace
}  // namespace frond
