#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "render/plugins.h"
#include "scene/plugin_library.h"
#include "tests/cli/command.h"
#include "tests/support/input_error.h"

/// Shared objects made by tests/CMakeLists.txt from tests/plugins.
namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
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
              HasSubstr("has version 2 of the plug-in interface, this frond has version 1: build it again"));
  EXPECT_THAT(refusal(library("other_build")),
              AllOf(HasSubstr("was built for frond 0.0.1 (contracts of old) with libstdc++, this is frond "),
                    EndsWith(": build it again")));
  EXPECT_THAT(refusal(library("unresolved")),
              AllOf(HasSubstr("gone_since_the_last_version"), HasSubstr("built for another one")));
  EXPECT_THAT(refusal(library("taken")), HasSubstr("there is a material \"diffuse\" already"));
  EXPECT_THAT(refusal(library("wrong_kind")), HasSubstr("offers \"lost\" as a material, but calls it a light"));
}

TEST(Plugin, FoldersAreSearchedInOrder) {
  TestFolder folder("plugin");
  for (const char* name : {"b/2.so", "b/1.so", "b/readme.txt", "a/3.so"}) folder.write(name, "");
  const std::string a = folder.name_of("a"), b = folder.name_of("b");
  EXPECT_THAT(plugins_in(b + "::" + a), ElementsAre(b + "/1.so", b + "/2.so", a + "/3.so"));
  EXPECT_THAT(plugins_in(""), ElementsAre());
  EXPECT_THAT(error_of([&] { plugins_in(a + ":/no/such/folder"); }), HasSubstr("no folder \"/no/such/folder\""));
}

class PluginCommands : public ::testing::Test {
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
  TestFolder folder_{"plugins"};
  std::string scene_ = folder_.name_of("scene.pbrt"), image_ = folder_.name_of("a.exr");
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

TEST_F(PluginCommands, TheSearchPathIsLoadedByItself) {
  fs::create_directory(folder_.name_of("path"));
  fs::copy(library("planted"), folder_.name_of("path/planted.so"));
  setenv("FROND_PLUGIN_PATH", folder_.name_of("path").c_str(), 1);
  const Outcome list = frond_command({"list"}),
                twice = frond_command({"list", "--plugin", folder_.name_of("path/planted.so")}),
                copied = frond_command({"list", "--plugin", library("planted")});
  unsetenv("FROND_PLUGIN_PATH");
  EXPECT_THAT(list.out, HasSubstr("picky"));
  EXPECT_EQ(twice.code, 0) << twice.err;
  EXPECT_THAT(copied.err, HasSubstr("there is a material \"picky\" already"));
}

}  // namespace
}  // namespace frond
