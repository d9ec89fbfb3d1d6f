// Errors of a scene that can be parsed: all of them are reported, without errors that only follow from others.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/log.h"
#include "core/messages/problems.h"
#include "integrators/registry.h"
#include "materials/registry.h"
#include "scene/format/parser.h"
#include "scene/scene.h"

namespace frond {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> errors_of(const std::string& text) {
  ThreadPool pool(1);
  Problems problems;
  problems.attempt([&] {
    Scene(parse_scene_text(text, "s", silent_log()), make_registry(builtin_materials(), builtin_integrators()), pool,
          silent_log());
  });
  return problems.messages();
}

TEST(SceneErrors, WithoutAFilmThereIsNoCameraToBeWrong) {
  // The camera stands too far away, which is seen once there is a film.
  const std::string camera = "Translate 0 0 1e18 Camera \"perspective\" ";
  EXPECT_THAT(errors_of(camera + "\nWorldBegin"), ElementsAre(HasSubstr("a ray of this camera starts at")));
  const std::string film = "Film \"rgb\" \"integer xresolution\" -5\n";
  EXPECT_THAT(errors_of(film + camera + "\nWorldBegin"), ElementsAre(HasSubstr("xresolution")));
  EXPECT_THAT(errors_of(film + "Camera \"perspective\" \"float fov\" -1\nWorldBegin"),
              ElementsAre(HasSubstr("xresolution"), HasSubstr("fov")))
      << "its parameters are looked at";
}

TEST(SceneErrors, OfBentNormalsHideNoOthers) {
  EXPECT_THAT(
      errors_of("WorldBegin\nMaterial \"diffuse\" \"bool normalmap\" true\nMaterial \"diffuse\" \"float foo\" 1\n"
                "Material \"diffuse\" \"bool displacement\" true\n"),
      ElementsAre(HasSubstr("s:2:"), HasSubstr("s:3:"), HasSubstr("s:4:")));
}

}  // namespace
}  // namespace frond
