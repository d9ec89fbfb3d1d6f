#include "render/live_view.h"

#include <gmock/gmock.h>

#include <condition_variable>
#include <mutex>

#include "image/exr.h"
#include "render/tev_viewer.h"
#include "tests/render/render_scene.h"
#include "tests/support/input_error.h"
#include "tests/support/tev_listener.h"

namespace frond {
namespace {

using test::SceneRender;
using test::TevListener;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class KeptLog final : public Log {
 public:
  void info(std::string_view) const override {}
  void warn(const Location&, std::string_view message) const override {
    const std::lock_guard lock(mutex_);
    warnings.emplace_back(message);
  }
  mutable std::vector<std::string> warnings;

 private:
  mutable std::mutex mutex_;
};

/// Records the images that it receives, and fails on request.
class TestViewer final : public Viewer {
 public:
  explicit TestViewer(size_t most = SIZE_MAX) : most_(most) {}
  void show(const Image& image) override {
    if (shown.size() == most_) fail({}, "enough");
    shown.push_back(image);
  }
  void end(bool) override {}
  std::vector<Image> shown;

 private:
  size_t most_;
};

/// Blocks until it is stopped.
class StuckViewer final : public Viewer {
 public:
  void show(const Image&) override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_over_; });
    fail({}, "it was stuck");
  }
  void end(bool) override {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_over_ = false;
};

/// The same channels of the whole image.
Image image_of(const RenderPart& part) {
  const Image whole = film_image(part.film, part.header.image);
  const std::vector<std::string> names = empty_image(part.film, part.header.image).channels;
  std::vector<size_t> channels;
  for (const std::string& name : names) channels.push_back(whole.channel(name).value());
  return whole.selected(channels, names);
}

class LiveViews : public ::testing::Test {
 protected:
  void SetUp() override { scene_ = folder_.write("scene.pbrt", test::a_scene()); }
  void render(const LoadedScene& scene, RenderPart& part, uint64_t samples = 16) {
    session_.render(scene, SampleRange{0, samples}, part);
  }

  TestFolder folder_{"live_view"};
  std::filesystem::path scene_;
  Session session_{silent_log(), {.threads = 2}};
  KeptLog log_;
};

TEST_F(LiveViews, ShowInTheEndWhatTheImageHas) {
  for (const SceneRender& how : {SceneRender{},
                                 {.channels = {"normal"}, .pixels = Crop{3, 2, 37, 20}},
                                 {.filter = "box"},
                                 {.filter = "mitchell"},
                                 {.wavelengths = "bands,wavelengths=430,500,560,610,680,780"},
                                 {.wavelengths = "bands,wavelengths=600,650", .filter = "box"}}) {
    const LoadedScene scene = how.load(session_, scene_);
    RenderPart part = scene.empty_part();
    TestViewer viewer;
    LiveView view(part.film, part.header.image, viewer, log_);
    render(scene, part);
    view.finish(false);
    ASSERT_THAT(viewer.shown, ::testing::Not(IsEmpty()));
    const Image expected = image_of(part);
    EXPECT_EQ(viewer.shown.back().channels, expected.channels);
    EXPECT_EQ(viewer.shown.back().pixels, expected.pixels) << how.wavelengths << ' ' << how.filter;
    EXPECT_EQ(std::ranges::count(expected.channels, "R"), how.wavelengths == "bands,wavelengths=600,650" ? 0 : 1);
  }
  EXPECT_THAT(log_.warnings, IsEmpty());
}

TEST_F(LiveViews, ShowHalvesWhereTheFileHasThem) {
  const LoadedScene scene = SceneRender{}.load(session_, scene_);
  RenderPart part = scene.empty_part();
  render(scene, part);
  TestViewer viewer;
  LiveView(part.film, part.header.image, viewer, log_).finish(true);
  Image expected = image_of(part);
  round_to_halves(expected.pixels);
  EXPECT_EQ(viewer.shown.back().pixels, expected.pixels);
  EXPECT_NE(expected.pixels, image_of(part).pixels);
}

TEST_F(LiveViews, ChangeNothingInTheFilm) {
  const LoadedScene scene = SceneRender{.channels = {"depth"}}.load(session_, scene_);
  RenderPart alone = scene.empty_part(), watched = scene.empty_part();
  render(scene, alone);
  TestViewer viewer;
  LiveView view(watched.film, watched.header.image, viewer, log_);
  render(scene, watched);
  EXPECT_EQ(watched.film, alone.film);
}

/// A view shows whole items only, while other threads add to the film: all samples are equal, so that a partial item
/// would show as another value.
TEST_F(LiveViews, SeeWholeItemsOnly) {
  const auto scene_file = folder_.write("sky.pbrt", R"(
Camera "orthographic"
Film "rgb" "integer xresolution" 70 "integer yresolution" 50
Integrator "path"
WorldBegin
LightSource "infinite" "spectrum L" [300 1 2500 1]
)");
  const LoadedScene scene = SceneRender{.wavelengths = "smpte"}.load(session_, scene_file);
  RenderPart part = scene.empty_part();
  Image image = empty_image(part.film, part.header.image);
  std::atomic<bool> is_over = false;
  std::jthread renderer([&] {
    render(scene, part, 256);
    is_over = true;
  });
  float least = INFINITY, most = 0;
  bool is_last = false;
  do {
    is_last = is_over;
    ASSERT_TRUE(update_image(part.film, part.header.image, {}, image));
    for (size_t i = 0; i < image.pixels.size(); i += 3)
      if (const float red = image.pixels[i]; red != 0) least = std::min(least, red), most = std::max(most, red);
  } while (!is_last);
  EXPECT_GT(least, 0);
  EXPECT_LT(most - least, 1e-4f * most);
}

TEST_F(LiveViews, OfAViewerThatFailsAreAWarningAndTheRenderGoesOn) {
  const LoadedScene scene = SceneRender{}.load(session_, scene_);
  RenderPart part = scene.empty_part();
  TestViewer viewer(0);
  LiveView view(part.film, part.header.image, viewer, log_);
  render(scene, part);
  view.finish(false);
  EXPECT_THAT(log_.warnings, ElementsAre(HasSubstr("display: enough; ")));
  EXPECT_THAT(viewer.shown, IsEmpty());
}

TEST_F(LiveViews, DoNotWaitForWhatIsStuck) {
  const LoadedScene scene = SceneRender{}.load(session_, scene_);
  RenderPart part = scene.empty_part();
  StuckViewer left;
  { const LiveView view(part.film, part.header.image, left, log_); }
  EXPECT_THAT(log_.warnings, IsEmpty());
  StuckViewer finished;
  LiveView(part.film, part.header.image, finished, log_).finish(false);
  EXPECT_THAT(log_.warnings, SizeIs(1));
}

TEST_F(LiveViews, GoToTevAsItIsSpokenTo) {
  for (const char* wavelengths : {"hero", "bands,wavelengths=430,500,560,610,680,780"}) {
    TevListener listener;
    const LoadedScene scene = SceneRender{.wavelengths = wavelengths}.load(session_, scene_);
    RenderPart part = scene.empty_part();
    {
      TevViewer viewer({"127.0.0.1", listener.port()}, "scene");
      LiveView view(part.film, part.header.image, viewer, log_);
      render(scene, part);
      view.finish(false);
    }
    listener.join();
    EXPECT_THAT(listener.faults(), IsEmpty());
    ASSERT_THAT(listener.images(), SizeIs(1));
    const auto& [name, image] = *listener.images().begin();
    const Image expected = image_of(part);
    EXPECT_EQ(name, "scene");
    EXPECT_EQ(image.width, expected.width);
    EXPECT_EQ(image.height, expected.height);
    EXPECT_EQ(image.channels, expected.channels);
    for (size_t c = 0; c < expected.channels.size(); ++c)
      EXPECT_EQ(image.values.at(expected.channels[c]), expected.plane(c)) << expected.channels[c];
    EXPECT_THAT(image.updates, ::testing::Each(::testing::Ge(1)));
  }
  EXPECT_THAT(log_.warnings, IsEmpty());
}

/// Only changed rows are sent, except for the whole image at the end.
TEST_F(LiveViews, SendTevWhatHasChanged) {
  TevListener listener;
  Image image(3, 2 * Film::kTile, {"R", "G", "B"});
  {
    TevViewer viewer({"127.0.0.1", listener.port()}, "image");
    viewer.show(image);
    image.at(1, Film::kTile, 2) = 1;
    viewer.show(image);
    viewer.show(image);
    viewer.end(false);
    viewer.show(image);
  }
  listener.join();
  EXPECT_THAT(listener.faults(), IsEmpty());
  const std::vector<int>& updates = listener.images().at("image").updates;
  EXPECT_EQ(updates.front(), 1);
  EXPECT_EQ(updates.back(), 2);
}

}  // namespace
}  // namespace frond
