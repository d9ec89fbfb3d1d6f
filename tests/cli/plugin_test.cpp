#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "image/image_file.h"
#include "render/plugins.h"
#include "scene/plugin_library.h"
#include "tests/support/command_test.h"

/// Shared objects made by tests/CMakeLists.txt from tests/plugins.
namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

std::string library(const std::string& name) { return FROND_TEST_PLUGINS "/" + name + ".so"; }

std::string refusal(const std::string& file) {
  return error_of([&] { load_registry(std::vector{file}); });
}

TEST(Plugin, AddsToTheTablesOfTheBuild) {
  const Registry registry = load_registry(std::vector{library("planted")});
  EXPECT_TRUE(registry.materials.find("wrong_warp"));
  EXPECT_TRUE(registry.materials.find("abm"));
  EXPECT_FALSE(builtin_registry().materials.find("wrong_warp"));
}

TEST(Plugin, DeclarationsOfTheBuildAreInOrder) {
  const auto all = all_plugins(builtin_registry());
  EXPECT_GT(all.size(), 60u);
  for (const PluginInfo* info : all) EXPECT_EQ(declaration_problem(*info), "") << info->kind << " " << info->name;
}

TEST(Plugin, GivenTwiceIsAddedOnce) {
  const Registry once = load_registry(std::vector{library("planted")}),
                 twice = load_registry(std::vector{library("planted"), library("planted")});
  EXPECT_EQ(once.materials.all(), twice.materials.all());
}

TEST(Plugin, WhatIsNoneIsRefusedWithAReason) {
  TestFolder folder("plugin");
  EXPECT_THAT(refusal("/no/such/lib.so"), HasSubstr("\"/no/such/lib.so\": there is no such file"));
  EXPECT_THAT(refusal(folder.write("text.so", "not a shared object").string()),
              AllOf(HasSubstr("text.so\" cannot be loaded"), HasSubstr("file too short")));
  EXPECT_THAT(refusal(library("no_function")), HasSubstr("no_function.so\" has no function frond_plugin"));
  EXPECT_THAT(refusal(library("other_interface")),
              HasSubstr("has version 3 of the plug-in interface, this frond has version 2: build it again"));
  EXPECT_THAT(refusal(library("other_build")),
              HasSubstr("was compiled from other headers than this frond (core/math/vec.h): build it again"));
  EXPECT_THAT(refusal(library("without_record")), HasSubstr("does not say which headers it was compiled from"));
  EXPECT_THAT(refusal(library("wrong_default")),
              HasSubstr("light \"deep\": the default of \"depth\" has the wrong type: it takes a number"));
  EXPECT_THAT(refusal(library("unresolved")),
              AllOf(HasSubstr("gone_since_the_last_version"), HasSubstr("built for another one")));
  EXPECT_THAT(refusal(library("taken")), HasSubstr("material \"diffuse\" already exists"));
  EXPECT_THAT(refusal(library("wrong_kind")), HasSubstr("offers \"lost\" as a material, but calls it a light"));
}

/// A change of any other header then does not reject the plug-in.
TEST(Plugin, RecordsTheHeadersThatItIncludesAndNoOthers) {
  std::ifstream file(library("kinds"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  for (const std::string header : {"core/plugin_module.h", "core/light.h", "core/math/vec.h"})
    EXPECT_THAT(bytes, HasSubstr(header + " ")) << header;
  for (const std::string header : {"report/table.h", "scene/scene.h", "jobs/record/job.h"})
    EXPECT_THAT(bytes, Not(HasSubstr(header))) << header;
}

TEST(Plugin, FoldersAreSearchedInOrder) {
  TestFolder folder("plugin");
  for (const char* name : {"b/2.so", "b/1.so", "b/readme.txt", "a/3.so"}) folder.write(name, "");
  const std::string a = folder.name_of("a"), b = folder.name_of("b");
  EXPECT_THAT(plugins_in(b + "::" + a), ElementsAre(b + "/1.so", b + "/2.so", a + "/3.so"));
  EXPECT_THAT(plugins_in(""), ElementsAre());
  EXPECT_THAT(error_of([&] { plugins_in(a + ":/no/such/folder"); }), HasSubstr("no folder \"/no/such/folder\""));
}

class PluginCommands : public CommandTest {
 protected:
  void SetUp() override {
    folder_.write("scene.pbrt", R"(
Film "rgb" "integer xresolution" 4 "integer yresolution" 4
WorldBegin
LightSource "infinite"
Material "picky"
  "float level" 0.95
Shape "sphere"
)");
  }
  std::string scene_ = path("scene.pbrt"), image_ = path("a.exr");
};

TEST_F(PluginCommands, ListAndDescribeKnowThem) {
  EXPECT_THAT(frond_command({"list", "--plugin", library("planted")}).out, HasSubstr("picky"));
  EXPECT_THAT(frond_command({"describe", "--plugin", library("planted"), "picky"}).out, HasSubstr("Below 0.9."));
  EXPECT_EQ(frond_command({"describe", "picky"}).code, 1);
}

/// The error is thrown by code in the shared object and caught in the program.
TEST_F(PluginCommands, ErrorsInTheirParametersNameTheirPlace) {
  EXPECT_THAT(frond_command({"render", scene_, "--plugin", library("planted"), "-o", image_}).err,
              HasSubstr("scene.pbrt:6:17: \"level\" is 0.95, and picky wants less than 0.9"));
  EXPECT_THAT(frond_command({"render", scene_, "-o", image_}).err, HasSubstr("unknown material \"picky\""));
  EXPECT_FALSE(fs::exists(image_));
}

TEST_F(PluginCommands, RenderUsesTheirMaterials) {
  EXPECT_EQ(
      frond_command({"render", scene_, "--plugin", library("planted"), "--swap", "picky=good", "-o", image_, "-q"})
          .code,
      0);
  EXPECT_TRUE(fs::exists(image_));
}

/// By formulas: what a camera that looks down on a square sees of it, in 4096 samples. Where these are random the
/// tolerance is six standard errors at least: a false alarm in 10^8.
class PluginKinds : public CommandTest {
 protected:
  /// The mean of green in the image of the scene, whose film is 8 x 8.
  double render(const std::string& world, const std::vector<std::string>& plugins) {
    const std::string scene = folder_
                                  .write("scene.pbrt", R"(LookAt 0 0 3  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [ -0.9 0.9 -0.9 0.9 ]
Film "square"
Sampler "independent" "integer pixelsamples" 64
PixelFilter "box"
WorldBegin
)" + world)
                                  .string();
    std::vector<std::string> words{"render", scene, "-o", path("a.exr"), "-q"};
    for (const std::string& name : plugins) words.insert(words.end(), {"--plugin", library(name)});
    const Outcome outcome = frond_command(words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    if (outcome.code != 0) return 0;
    const ImageFile file = read_image(path("a.exr"), {});
    EXPECT_EQ(file.image.width, 8);
    EXPECT_EQ(file.image.height, 8);
    EXPECT_GT(file.image.channels.size(), 3u) << "depth";
    double sum = 0;
    for (int y = 0; y < file.image.height; ++y)
      for (int x = 0; x < file.image.width; ++x) sum += double(file.image.at(x, y, 1));
    return sum / (file.image.width * file.image.height);
  }
  std::string refusal(const std::string& scene) {
    return frond_command({"render", folder_.write("refused.pbrt", scene).string(), "--plugin", library("kinds"), "-o",
                          path("b.exr")})
        .err;
  }
};

TEST_F(PluginKinds, AFilmAShapeAndAnAreaLightRender) {
  // The light itself, from its front.
  const double front = render("AreaLightSource \"glow\" \"rgb L\" [ 0.5 0.5 0.5 ]\nShape \"tile\"\n", {"kinds"});
  EXPECT_NEAR(front, 0.5, 0.01);
  // Under a light that is very large and near, a white surface is as bright as it; both strategies take part.
  const double lit = render(R"(Material "diffuse" "rgb reflectance" [ 1 1 1 ] Shape "tile"
AttributeBegin
  AreaLightSource "glow" Translate 0 0 5 Scale 500 500 -1 Rotate 180 1 0 0 Shape "tile"
AttributeEnd
)",
                            {"kinds"});
  EXPECT_NEAR(lit, 1, 0.03);
}

TEST_F(PluginKinds, TheExamplesRender) {
  // I cos^m of the angle from the axis, m = 1 at 120 degrees: E = I cos(angle)^4 / h^2 of a point below. cos(angle)^4
  // is 1 - 2 r^2 / h^2 at a distance r from the axis, whose mean square is 2 (0.9^2) / 3. By its
  // wavelengths the green of a path varies by 3 %: 0.001 is 6 standard errors.
  const double lit = render(R"(LightSource "led" "point3 from" [ 0 0 20 ] "point3 to" [ 0 0 0 ] "float scale" 400
Material "diffuse" "rgb reflectance" [ 1 1 1 ]
Shape "tile"
)",
                            {"kinds", "led"});
  EXPECT_NEAR(lit, (1 - 2 * 0.54 / (20 * 20)) / std::numbers::pi, 0.001);
  // A blade that lies flat, 1.6 by 1.6 at its base, hides 2/3 of 1.6^2 of the window's 1.8^2.
  const double seen = render(R"(LightSource "infinite"
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
Translate 0 -0.8 0 Rotate -90 1 0 0
Shape "blade" "float length" 1.6 "float width" 1.6 "float bend" 0 "integer segments" 100
)",
                             {"kinds", "blade"});
  EXPECT_NEAR(seen, 1 - 2 * 1.6 * 1.6 / (3 * 1.8 * 1.8), 0.05);
}

TEST_F(PluginKinds, WhatTheyMakeWrongIsRefusedAtItsPlace) {
  EXPECT_THAT(refusal("WorldBegin\nShape \"torn\"\n"),
              HasSubstr("refused.pbrt:2:7: shape \"torn\" has a defect: it has made a mesh of 2 vertices with a "
                        "triangle that names number 2"));
  EXPECT_THAT(refusal("WorldBegin\nLightSource \"nothing\"\nShape \"sphere\"\n"),
              HasSubstr("refused.pbrt:2:13: light \"nothing\" has a defect: make() returned nothing"));
  EXPECT_THAT(refusal("WorldBegin\nAreaLightSource \"glow\" \"bool nothing\" true\nShape \"tile\"\n"),
              HasSubstr("refused.pbrt:2:17: area light \"glow\" has a defect: make() returned nothing"));
  EXPECT_THAT(refusal("WorldBegin\nLightSource \"nothing\" \"bool throws\" true\nShape \"sphere\"\n"),
              HasSubstr("refused.pbrt:2:13: light \"nothing\" has a defect: thrown on purpose"));
  for (const auto& [how, what] :
       {std::pair{"odd", "which from 0 on are no pairs"}, std::pair{"normals", "with 1 normals"},
        std::pair{"null", "make() returned nothing"}, std::pair{"endless", "reaches to"}})
    EXPECT_THAT(refusal(std::string("WorldBegin\nShape \"torn\" \"string how\" \"") + how + "\"\n"),
                AllOf(HasSubstr("refused.pbrt:2:7: "), HasSubstr(what)));
  EXPECT_THAT(refusal("Film \"square\" \"integer pixels\" 0\nWorldBegin\nShape \"sphere\"\n"),
              HasSubstr("refused.pbrt:1:6: film \"square\" has 0 x 0 pixels: 1 to 65536 are possible"));
}

TEST_F(PluginCommands, TheSearchPathIsLoadedByItself) {
  fs::create_directory(path("path"));
  fs::copy(library("planted"), path("path/planted.so"));
  setenv("FROND_PLUGIN_PATH", path("path").c_str(), 1);
  const Outcome list = frond_command({"list"}), twice = frond_command({"list", "--plugin", path("path/planted.so")}),
                copied = frond_command({"list", "--plugin", library("planted")});
  unsetenv("FROND_PLUGIN_PATH");
  EXPECT_THAT(list.out, HasSubstr("picky"));
  EXPECT_EQ(twice.code, 0) << twice.err;
  EXPECT_THAT(copied.err, HasSubstr("material \"picky\" already exists"));
}

}  // namespace
}  // namespace frond
