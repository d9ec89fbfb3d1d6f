#include "core/stop.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace frond {
namespace {

using Clock = std::chrono::steady_clock;

TEST(Stop, ADeadlineEndsLoopsAndNothingAfterItsScope) {
  {
    const DeadlineScope scope(Clock::now());
    EXPECT_THROW(check_stop(), Stopped);
    EXPECT_THROW(ThreadPool(2).for_each(1, [](int64_t, int) {}), Stopped);
  }
  EXPECT_NO_THROW(check_stop());
}

TEST(Stop, TheEarliestOfNestedDeadlinesCounts) {
  const DeadlineScope far(Clock::now() + std::chrono::hours(1)), none(std::nullopt);
  EXPECT_NO_THROW(check_stop());
  const DeadlineScope now(Clock::now());
  const DeadlineScope later(Clock::now() + std::chrono::hours(2));
  EXPECT_THROW(check_stop(), Stopped);
}

TEST(Stop, ThreadsOfALoopObserveTheDeadlineOfTheThreadThatStartedIt) {
  const DeadlineScope scope(Clock::now() + std::chrono::milliseconds(50));
  std::atomic<bool> is_cut = true;
  const auto endless = [&](int64_t, int) {
    for (StopPoll poll;;) poll();
    is_cut = false;
  };
  EXPECT_THROW(ThreadPool(3).for_each(3, endless), Stopped);
  EXPECT_TRUE(is_cut);
}

TEST(Stop, ATokenAndADeadlineCountBoth) {
  std::stop_source source;
  const StopScope stop(source.get_token());
  const DeadlineScope deadline(Clock::now() + std::chrono::hours(1));
  EXPECT_FALSE(is_stop_requested());
  source.request_stop();
  EXPECT_TRUE(is_stop_requested());
}

TEST(Stop, WhatMustBeCompleteIsNotStopped) {
  std::stop_source source;
  source.request_stop();
  const StopScope stop(source.get_token());
  const DeadlineScope deadline(Clock::now());
  {
    const UnstoppableScope whole;
    EXPECT_NO_THROW(check_stop());
    int calls = 0;
    ThreadPool(1).for_each(3, [&](int64_t, int) { ++calls; });
    EXPECT_EQ(calls, 3);
  }
  EXPECT_THROW(check_stop(), Stopped);
}

TEST(Stop, AnotherThreadCanObserveIt) {
  std::stop_source source;
  const StopScope stop(source.get_token());
  const StopState state = current_stop();
  std::jthread([&] { EXPECT_FALSE(state.is_requested()); }).join();
  source.request_stop();
  std::jthread([&] {
    EXPECT_TRUE(state.is_requested());
    EXPECT_FALSE(is_stop_requested());
  }).join();
}

TEST(Stop, APollChecksNowAndThen) {
  std::stop_source source;
  source.request_stop();
  const StopScope stop(source.get_token());
  StopPoll poll;
  int calls = 0;
  EXPECT_THROW(for (;; ++calls) poll(), Stopped);
  EXPECT_GT(calls, 0);
  EXPECT_LT(calls, 5000);
}

}  // namespace
}  // namespace frond
