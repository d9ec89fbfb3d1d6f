#include "render/checkpoint.h"

#include <gmock/gmock.h>

#include <atomic>
#include <thread>

#include "render/film/adaptive.h"
#include "render/parts/part_file.h"
#include "tests/render/render_scene.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using test::SceneRender;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

TEST(PartLocks, HoldOffOthersUntilTheyAreGone) {
  const TestFolder folder("lock");
  const fs::path part = folder.name_of("a.part");
  {
    const PartLock lock(part);
    EXPECT_THAT(error_of([&] { const PartLock second(part); }), HasSubstr("another frond process is writing"));
    EXPECT_EQ(error_of([&] { const PartLock other(folder.name_of("b.part")); }), "");
  }
  EXPECT_EQ(error_of([&] { const PartLock again(part); }), "");
  EXPECT_FALSE(fs::exists(part.string() + ".lock"));
  EXPECT_THAT(error_of([&] { const PartLock none(folder.name_of("none/a.part")); }), HasSubstr("cannot write"));
}

/// Also if one process opens the file while another one deletes it.
TEST(PartLocks, AreHeldByOneAtATime) {
  const TestFolder folder("lock");
  const fs::path part = folder.name_of("a.part");
  std::atomic<int> holders = 0, held = 0, together = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&] {
        for (int i = 0; i < 3000; ++i) {
          error_of([&] {
            const PartLock lock(part);
            if (++holders > 1) ++together;
            ++held;
            std::this_thread::yield();
            --holders;
          });
        }
      });
  }
  EXPECT_GT(held, 0);
  EXPECT_EQ(together, 0);
}

class Checkpoints : public ::testing::Test {
 protected:
  void SetUp() override { scene_ = folder_.write("scene.pbrt", test::a_scene()); }

  TestFolder folder_{"checkpoints"};
  fs::path scene_, path_ = folder_.name_of("a.part");
  Session session_{silent_log(), {.threads = 2}};
};

class Warnings final : public Log {
 public:
  void info(std::string_view) const override {}
  void warn(const Location&, std::string_view message) const override {
    const std::lock_guard lock(mutex_);
    messages_.emplace_back(message);
  }
  std::vector<std::string> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::vector<std::string> messages_;
};

void wait_for(const auto& condition) {
  for (int i = 0; i < 5000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  EXPECT_TRUE(condition());
}

TEST_F(Checkpoints, ComeByTheClockAndWarnWhereTheyCannotBeWritten) {
  const LoadedScene scene = SceneRender{}.load(session_, scene_);
  const RenderPart part = scene.empty_part();
  const Warnings log;
  const Checkpointer checkpointer(path_, 0.005, part, nullptr, log);
  wait_for([&] { return fs::exists(path_); });
  EXPECT_TRUE(log.messages().empty());
  // A folder is no place for a file. Between the two calls the clock may put another checkpoint there.
  std::error_code taken;
  do {
    fs::remove(path_);
  } while (!fs::create_directory(path_, taken));
  wait_for([&] { return !log.messages().empty(); });
  EXPECT_THAT(log.messages().front(), HasSubstr("no checkpoint was written, rendering goes on: "));
  fs::remove(path_);
  wait_for([&] { return fs::is_regular_file(path_); });
  EXPECT_EQ(read_part(path_).film, part.film);
}

/// Each checkpoint contains whole work items, and its header states no more than these.
TEST_F(Checkpoints, OfARenderAtWorkCanBeGoneOnFrom) {
  const LoadedScene scene = SceneRender{}.load(session_, scene_);
  constexpr SampleRange kSamples{0, 256};
  RenderPart whole = scene.empty_part(), part = scene.empty_part();
  session_.render(scene, kSamples, whole);
  Checkpointer checkpointer(path_, 1000, part, nullptr, silent_log());
  std::vector<RenderPart> checkpoints;
  {
    const std::jthread writer([&](const std::stop_token& stop) {
      do {  // once at least, however late this thread begins
        checkpointer.write();
        checkpoints.push_back(read_part(path_));
      } while (!stop.stop_requested());
    });
    session_.render(scene, kSamples, part, {.progress = &checkpointer});
  }
  ASSERT_FALSE(checkpoints.empty());
  for (size_t i = 0; i < checkpoints.size(); i += 1 + checkpoints.size() / 8) {
    RenderPart& from = checkpoints[i];
    uint64_t paths = 0;
    for (size_t t = 0; t < from.film.tiles(); ++t)
      for (const WorkItem& item : from.film.tile(t).coverage().items()) paths += item.paths();
    EXPECT_LE(from.header.statistics.paths, paths);
    session_.render(scene, kSamples, from);
    EXPECT_EQ(from.film, whole.film);
  }
}

/// A checkpoint contains samples of one plan only: with samples of the next plan, the next plan would be computed again
/// with another result.
TEST_F(Checkpoints, OfAnAdaptiveRenderAreOfOnePlan) {
  // The sky, which needs few samples, comes first: pixels that need more have them before the checkpoint is written
  // there.
  scene_ = folder_.write("tall.pbrt", test::a_scene("", 40, 600));
  const LoadedScene scene =
      SceneRender{.wavelengths = "smpte", .channels = {"normal", "position"}, .adaptive = true}.load(session_, scene_);
  const NoiseRequest request{.max_rms = 0.002};
  RenderPart whole = scene.empty_part();
  session_.render_to(scene, request, whole);
  ASSERT_GT(whole.header.round, 0);
  RenderPart part = scene.empty_part();
  Checkpointer checkpointer(path_, 1000, part, nullptr, silent_log());
  std::vector<RenderPart> checkpoints;
  {
    std::vector<std::jthread> writers;
    std::mutex one_at_a_time;
    NoiseRequest watched = request;
    // One is begun, as if by the clock, just before the plan changes.
    watched.on_change = [&](const auto& change, const PartHeader& header) {
      writers.emplace_back([&] {
        const std::lock_guard lock(one_at_a_time);
        checkpointer.write();
        checkpoints.push_back(read_part(path_));
      });
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      checkpointer.change_part(change, header);
    };
    session_.render_to(scene, watched, part, {.progress = &checkpointer});
  }
  EXPECT_EQ(part.film, whole.film);
  for (RenderPart& from : checkpoints) {
    for (size_t t = 0; t < from.film.tiles(); ++t)
      for (const WorkItem& item : from.film.tile(t).coverage().items()) {
        ASSERT_FALSE(from.header.tile_ends.empty());
        ASSERT_LE(item.samples.end, from.header.tile_ends[t]) << "round " << from.header.round;
        if (item.samples.end > kLeastAdaptive / 2) {
          ASSERT_EQ(2 * from.film.tile(t).samples_in_first_half(), double(from.header.tile_ends[t]));
        }
      }
    if (&from != &checkpoints[checkpoints.size() / 2]) continue;
    session_.render_to(scene, request, from);
    EXPECT_EQ(from.film, whole.film);
    EXPECT_EQ(from.header.tile_ends, whole.header.tile_ends);
  }
}

}  // namespace
}  // namespace frond
