#include "system/cache_limit.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "core/log.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

namespace fs = std::filesystem;
using std::chrono::hours;

std::string leaf_file(int number, std::string_view extension = "csv") {
  return fmt::format("leaf-{:016x}.{}", number, extension);
}

class CacheLimit : public testing::Test {
 protected:
  /// A file of 1000 bytes.
  fs::path file(const std::string& name, hours unused) const {
    const fs::path path = folder_.write(name, std::string(1000, 'x'));
    fs::last_write_time(path, now_ - unused);
    return path;
  }
  bool has(const std::string& name) const { return fs::exists(folder_.name_of(name)); }

  TestFolder folder_{"cache_limit"};
  fs::file_time_type now_ = fs::file_time_type::clock::now();
};

TEST_F(CacheLimit, DeletesWhatLayUnusedForLongest) {
  const fs::path newest = file(leaf_file(1), hours(9));
  file(leaf_file(2, "modes"), hours(3));
  file(leaf_file(3), hours(2));
  mark_as_used(file(leaf_file(4), hours(4)));
  file(leaf_file(5), hours(30));
  limit_cache(newest, {"leaf-", 3500}, silent_log());
  EXPECT_TRUE(has(leaf_file(1)));
  EXPECT_FALSE(has(leaf_file(2, "modes")));
  EXPECT_TRUE(has(leaf_file(3)));
  EXPECT_TRUE(has(leaf_file(4)));
  EXPECT_FALSE(has(leaf_file(5)));
}

TEST_F(CacheLimit, KeepsTheNewestHoweverLargeItIs) {
  limit_cache(file(leaf_file(1), hours(9)), {"leaf-", 10}, silent_log());
  EXPECT_TRUE(has(leaf_file(1)));
}

TEST_F(CacheLimit, LeavesAloneWhatIsNotItsKind) {
  const std::vector<std::string> others = {"reference-0000000000000001.bin",
                                           "leaf-photograph-of-may.csv",
                                           "leaf-00000000000000012.csv",
                                           "leaf-0000000000000001",
                                           "leaf-",
                                           "notes.tmp"};
  for (const std::string& name : others) file(name, hours(99));
  limit_cache(file(leaf_file(1), hours(0)), {"leaf-", 0}, silent_log());
  for (const std::string& name : others) EXPECT_TRUE(has(name)) << name;
}

TEST_F(CacheLimit, DeletesTemporaryFilesOfRunsThatWereKilled) {
  const std::string of_before = leaf_file(2) + ".1234.tmp";
  for (const std::string& name : {std::string(".frond-12-0.tmp"), of_before}) file(name, hours(25));
  file(".frond-34-0.tmp", hours(23));
  limit_cache(file(leaf_file(1), hours(0)), {"leaf-", 1500}, silent_log());
  EXPECT_FALSE(has(".frond-12-0.tmp"));
  EXPECT_FALSE(has(of_before));
  EXPECT_TRUE(has(".frond-34-0.tmp"));
}

TEST_F(CacheLimit, IsKeptByManyAtATime) {
  for (int i = 1; i <= 400; ++i) file(leaf_file(i), hours(i));
  std::vector<std::jthread> others;
  for (int i = 0; i < 4; ++i)
    others.emplace_back([this] { limit_cache(folder_.name_of(leaf_file(1)), {"leaf-", 100'000}, silent_log()); });
  others.clear();
  for (int i = 1; i <= 400; ++i) EXPECT_EQ(has(leaf_file(i)), i <= 100) << i;
}

TEST_F(CacheLimit, OfAFolderThatIsGoneIsNoError) {
  limit_cache(folder_.name_of("none") + "/" + leaf_file(1), {"leaf-", 0}, silent_log());
  mark_as_used(folder_.name_of("none"));
  EXPECT_FALSE(has("none"));
}

}  // namespace
}  // namespace frond
