#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/log.h"
#include "scene/read_scene.h"
#include "tests/support/render_text.h"

namespace frond {
namespace {

/// A scene of the project at two samples a pixel, its leaves by a table that costs no walks.
Film render_scene(const std::string& path) {
  const Log& quiet = silent_log();
  ThreadPool pool(2);
  SceneDescription description = parse_scene(FROND_SOURCE_DIR "/scenes/" + path, quiet);
  const Registry registry = make_registry(builtin_materials(), builtin_integrators());
  SceneOverrides overrides;
  overrides.wavelengths = "smpte";
  if (path.starts_with("soybean")) overrides.swaps = {{"leaf", {"leaf_simplified", {{"tablemethod", "solve"}}}}};
  apply_overrides(overrides, description, registry, quiet);
  const Scene scene(description, registry, pool, quiet);
  Film film({.settings = scene.film()});
  render(job_of(scene), plan_of(film, {0, 2}), film, pool);
  return film;
}

/// The paper's foliar ratios (table 2), within 0.3 % of the view; half a million stratified camera rays leave a
/// standard error below 0.06 %, far less than what the margin has left.
TEST(Scenes, LeavesCoverThePapersShareOfTheView) {
  EXPECT_NEAR(render_scene("soybean-front/scene.pbrt").foliar_ratio(), 0.2497, 0.003);
  EXPECT_NEAR(render_scene("soybean-back/scene.pbrt").foliar_ratio(), 0.1942, 0.003);
  EXPECT_NEAR(render_scene("soybean-ambient/scene.pbrt").foliar_ratio(), 0.3761, 0.003);
}

/// A mean over 4096 pixels whose standard error is known; 5 of them: a false alarm in 1.7 million.
TEST(Scenes, FurnacesAreWhite) {
  for (const char* path : {"furnace/scene.pbrt", "furnace/transmission.pbrt"}) {
    const auto [mean, error] = test::channel_mean(render_scene(path), 1);
    EXPECT_NEAR(mean, 1, 5 * error + 1e-5) << path;
  }
}

// Files with WorldBegin are scenes; some of the canopies need tables of leaves that their scripts make.
TEST(Scenes, AllCanBeRead) {
  const Registry registry = make_registry(builtin_materials(), builtin_integrators());
  ThreadPool pool(1);
  int scenes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(FROND_SOURCE_DIR "/scenes")) {
    const std::filesystem::path& path = entry.path();
    if (path.extension() != ".pbrt" || path.parent_path().filename() == "canopy") continue;
    std::ifstream file(path);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    if (text.find("\nWorldBegin") == std::string::npos) continue;
    ++scenes;
    EXPECT_NO_THROW(Scene::check(read_scene(path, registry, silent_log()), registry, pool, silent_log())) << path;
  }
  EXPECT_GT(scenes, 20);
}

}  // namespace
}  // namespace frond
