#include "cli/progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

namespace frond {
namespace {

RenderStatistics so_far(double seconds) {
  RenderStatistics s;
  s.paths = 2'000'000, s.rays = 6'000'000, s.wall_seconds = seconds;
  return s;
}

/// Returns what two updates write where standard error is no terminal.
std::string written(bool quiet, double seconds_between_lines) {
  ::testing::internal::CaptureStderr();  // into a file
  ProgressLine progress(quiet, seconds_between_lines);
  progress.update(0.25, so_far(30));
  progress.update(0.5, so_far(60));
  progress.finish();
  return ::testing::internal::GetCapturedStderr();
}

TEST(Progress, WritesWholeLinesWithoutATerminal) {
  EXPECT_EQ(written(false, 0),
            " 25.0 %  2.0 M samples  0.20 M rays/s  90 s left\n 50.0 %  2.0 M samples  0.10 M rays/s  60 s left\n");
}

TEST(Progress, WritesNothingOfShortWorksOfALongJob) {
  ::testing::internal::CaptureStderr();
  ProgressLine progress(false, 0.01);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  progress.update(0.5, so_far(0.001));
  progress.finish();
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Progress, WritesNothingOfShortJobsNorIfQuiet) {
  EXPECT_EQ(written(false, 30), "");
  EXPECT_EQ(written(true, 0), "");
}

}  // namespace
}  // namespace frond
