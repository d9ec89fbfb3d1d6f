#include "scene/format/parser.h"

#include <gmock/gmock.h>

#include "core/log.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

SceneDescription parse(const std::string& text) { return parse_scene_text(text, "s.pbrt", silent_log()); }
SceneDescription parse_world(const std::string& text) { return parse("WorldBegin\n" + text); }

const std::vector<double>& numbers(const ParsedParam& p) { return std::get<std::vector<double>>(p.values); }
const std::vector<std::string>& strings(const ParsedParam& p) { return std::get<std::vector<std::string>>(p.values); }
const std::vector<bool>& booleans(const ParsedParam& p) { return std::get<std::vector<bool>>(p.values); }

/// Parameters of one sphere.
std::vector<ParsedParam> params_of(const std::string& text) {
  return parse_world("Shape \"sphere\" " + text).shapes.at(0).plugin.params;
}

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-6);
  EXPECT_NEAR(a.y, b.y, 1e-6);
  EXPECT_NEAR(a.z, b.z, 1e-6);
}

TEST(Parser, HasDefaultsForWhatTheSceneLeavesOut) {
  const SceneDescription s = parse("WorldBegin");
  EXPECT_EQ(s.camera.name, "perspective");
  EXPECT_EQ(s.film.name, "rgb");
  EXPECT_EQ(s.sampler.name, "lattice");
  EXPECT_EQ(s.integrator.name, "path");
  EXPECT_EQ(s.filter.name, "gaussian");
  EXPECT_EQ(s.color_space, "srgb");
  ASSERT_EQ(s.materials.size(), 1u);
  EXPECT_EQ(s.materials[0].plugin.name, "diffuse");
}

TEST(Parser, ReadsTheOptionsBlock) {
  const SceneDescription s = parse(R"(
ColorSpace "rec2020"
Camera "orthographic" "float screenwindow" [ -1 1 -2 2 ]
Film "gbuffer" "integer xresolution" 640
Sampler "independent" "integer pixelsamples" [ 16 ]
Integrator "volpath" "integer maxdepth" 7
PixelFilter "box" "float xradius" .5
Accelerator "kdtree" "integer maxprims" 1
Option "integer seed" 3
Option "disablepixeljitter" true
Option "seed" 4
Option "displacementedgescale" .5
Option "msereferenceimage" "a.exr"
WorldBegin)");
  EXPECT_EQ(s.camera.name, "orthographic");
  EXPECT_THAT(numbers(s.camera.params[0]), ElementsAre(-1, 1, -2, 2));
  EXPECT_EQ(s.film.name, "gbuffer");
  EXPECT_EQ(s.film.params[0].name, "xresolution");
  EXPECT_EQ(s.sampler.name, "independent");
  EXPECT_EQ(s.integrator.name, "volpath");
  EXPECT_EQ(s.filter.name, "box");
  EXPECT_EQ(s.color_space, "rec2020");
  ASSERT_EQ(s.options.size(), 4u);  // what is given again counts
  const char* types[] = {"bool", "integer", "float", "string"};
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(s.options[i].type, types[i]);
  EXPECT_THAT(numbers(s.options[1]), ElementsAre(4));
}

TEST(Parser, SaysWhereThingsStand) {
  const SceneDescription s = parse("WorldBegin\n  Shape \"sphere\"\n\t\"float radius\"\n   [ 2 ] \"float zmin\" 1");
  const ParsedPlugin& sphere = s.shapes.at(0).plugin;
  EXPECT_EQ(sphere.where.text(), "s.pbrt:2:9: ");
  EXPECT_EQ(sphere.params[0].where.text(), "s.pbrt:3:2: ");
  EXPECT_EQ(sphere.params[0].value_where.text(), "s.pbrt:4:6: ");
  EXPECT_EQ(sphere.params[1].where.text(), "s.pbrt:4:10: ");
  EXPECT_EQ(sphere.params[1].value_where.text(), "s.pbrt:4:23: ");
  EXPECT_EQ(sphere.where.file, sphere.params[1].value_where.file) << "the name is shared, not copied";
}

TEST(Parser, ReadsNumbersInEveryNotation) {
  const auto p =
      params_of("\"float a\" [ 1e-3 -.5 +3 7. 0 -0 1E2 +.25e+1 1e-400 ] # the last is too small for anything");
  EXPECT_THAT(numbers(p[0]), ElementsAre(1e-3, -0.5, 3, 7, 0, 0, 100, 2.5, 0));
}

TEST(Parser, ReadsValuesOfEveryType) {
  const auto p = params_of(R"("integer i" 3 "bool b" true "bool c" [ true false "true" "false" ] "string s" "x y"
    "texture t" [ "wood" ] "rgb r" [ .1 .2 .3 ] "spectrum n" "metal-Cu" "spectrum v" [ 400 .1 700 .2 ]
    "blackbody k" 6500 "point2 p2" [1 2] "point p" [1 2 3] "point3 p3" [1 2 3] "vector v1" [1 2 3]
    "vector2 v2" [1 2] "vector3 v3" [1 2 3] "normal n1" [0 0 1] "normal3 n3" [0 0 1] "string none" [] )");
  EXPECT_THAT(numbers(p[0]), ElementsAre(3));
  EXPECT_THAT(booleans(p[1]), ElementsAre(true));
  EXPECT_THAT(booleans(p[2]), ElementsAre(true, false, true, false));
  EXPECT_THAT(strings(p[3]), ElementsAre("x y"));
  EXPECT_THAT(strings(p[4]), ElementsAre("wood"));
  EXPECT_EQ(p[5].type, "rgb");
  EXPECT_THAT(strings(p[6]), ElementsAre("metal-Cu"));
  EXPECT_THAT(numbers(p[7]), ElementsAre(400, 0.1, 700, 0.2));
  EXPECT_THAT(numbers(p[8]), ElementsAre(6500));
  ASSERT_EQ(p.size(), 18u);
  EXPECT_TRUE(strings(p[17]).empty());
}

TEST(Parser, ResolvesEscapesInStrings) {
  EXPECT_THAT(strings(params_of(R"("string s" "a\"b\\c\td\'e")")[0]), ElementsAre("a\"b\\c\td'e"));
}

TEST(Parser, TakesWindowsLineEndsBlankFreeListsAndAByteOrderMark) {
  const SceneDescription s = parse("\xef\xbb\xbfWorldBegin # begin\r\nShape\"sphere\"\"float radius\"[2]#end");
  EXPECT_THAT(numbers(s.shapes.at(0).plugin.params.at(0)), ElementsAre(2));
  EXPECT_EQ(s.shapes[0].plugin.where.text(), "s.pbrt:2:6: ");
}

TEST(Parser, ComposesTransformsSoThatTheLastActsFirst) {
  const SceneDescription s = parse_world("Translate 1 2 3 Rotate 90 0 0 1 Scale 2 2 2 Shape \"sphere\"");
  expect_near(s.shapes.at(0).world_from_object.point({1, 0, 0}), {1, 4, 3});
}

TEST(Parser, TakesMatricesColumnByColumn) {
  const std::string shear = "[ 1 0 0 0  0.5 1 0 0  0 0 1 0  10 20 30 1 ]";
  const SceneDescription s = parse_world("Scale 2 2 2 Transform " + shear + "Shape \"sphere\" ConcatTransform " +
                                         shear + "Shape \"sphere\" Identity Shape \"sphere\"");
  expect_near(s.shapes.at(0).world_from_object.point({0, 2, 0}), {11, 22, 30});
  expect_near(s.shapes.at(1).world_from_object.point({0, 2, 0}), {32, 42, 60});
  EXPECT_EQ(s.shapes.at(2).world_from_object, Transform());
}

TEST(Parser, KeepsTheCameraTransformAndStartsTheWorldWithIdentity) {
  const SceneDescription s = parse(R"(LookAt 0 0 5  0 0 0  0 1 0 Camera "perspective" WorldBegin Shape "sphere"
    CoordSysTransform "camera" Shape "sphere" CoordSysTransform "world" Shape "sphere")");
  expect_near(s.camera_from_world.start.point({0, 0, 0}), {0, 0, 5});
  EXPECT_EQ(s.shapes.at(0).world_from_object, Transform());
  expect_near(s.shapes.at(1).world_from_object.point({0, 0, 0}), {0, 0, 5});
  EXPECT_EQ(s.shapes.at(2).world_from_object, Transform());
}

TEST(Parser, RecallsNamedCoordinateSystems) {
  const SceneDescription s = parse_world(
      R"(Translate 1 0 0 CoordinateSystem "here" Translate 1 0 0 CoordSysTransform "here" LightSource "point")");
  EXPECT_EQ(s.lights.at(0).world_from_light, Transform::translate({1, 0, 0}));
  EXPECT_EQ(s.coordinate_systems.at("here").start, Transform::translate({1, 0, 0}));
}

TEST(Parser, BringsTheGraphicsStateBackAtAttributeEnd) {
  const SceneDescription s = parse_world(R"(
AttributeBegin
  Material "conductor" AreaLightSource "diffuse" "rgb L" [ 1 1 1 ]
  ReverseOrientation Scale -1 1 1
  Shape "disk"
AttributeEnd
Shape "sphere")");
  const ShapeDescription &disk = s.shapes.at(0), &sphere = s.shapes.at(1);
  EXPECT_EQ(s.materials[disk.material].plugin.name, "conductor");
  ASSERT_TRUE(disk.area_light);
  EXPECT_EQ(s.area_lights[*disk.area_light].params[0].name, "L");
  EXPECT_TRUE(disk.reverse_orientation);
  EXPECT_EQ(sphere.material, 0u);
  EXPECT_FALSE(sphere.area_light);
  EXPECT_FALSE(sphere.reverse_orientation);
}

TEST(Parser, ReverseOrientationTwiceIsNothing) {
  EXPECT_FALSE(parse_world("ReverseOrientation ReverseOrientation Shape \"sphere\"").shapes.at(0).reverse_orientation);
}

TEST(Parser, AnAreaLightWithoutANameEndsTheOneBefore) {
  const SceneDescription s = parse_world("AreaLightSource \"diffuse\" AreaLightSource \"\" Shape \"sphere\"");
  EXPECT_FALSE(s.shapes.at(0).area_light);
}

TEST(Parser, GivesMaterialsByNameBeforeOrAfterTheirDefinition) {
  const SceneDescription s = parse_world(R"(
NamedMaterial "leaf" Shape "disk"
MakeNamedMaterial "leaf" "float thickness" 1 "string type" "abm"
NamedMaterial "leaf" Shape "sphere")");
  const MaterialDescription& leaf = s.materials.at(s.shapes.at(0).material);
  EXPECT_EQ(s.shapes[0].material, s.shapes.at(1).material);
  EXPECT_EQ(leaf.name, "leaf");
  EXPECT_EQ(leaf.plugin.name, "abm");
  EXPECT_EQ(leaf.plugin.where.text(), "s.pbrt:4:60: ");
  ASSERT_EQ(leaf.plugin.params.size(), 1u);
  EXPECT_EQ(leaf.plugin.params[0].name, "thickness");
}

TEST(Parser, KeepsTexturesOfBothKindsInOrder) {
  const SceneDescription s = parse_world(R"(Texture "a" "float" "constant" "float value" 2
    Texture "a" "spectrum" "imagemap" "string filename" "a.png")");
  ASSERT_EQ(s.textures.size(), 2u);
  EXPECT_EQ(s.textures[0].value, TextureDescription::Value::real);
  EXPECT_EQ(s.textures[0].plugin.name, "constant");
  EXPECT_EQ(s.textures[1].name, "a");
  EXPECT_EQ(s.textures[1].value, TextureDescription::Value::spectrum);
  EXPECT_EQ(s.textures[1].plugin.params[0].name, "filename");
}

TEST(Parser, KeepsObjectsApartAndPlacesTheirInstances) {
  const SceneDescription s = parse_world(R"(
Translate 1 0 0
ObjectBegin "leaf"
  Material "abm" Scale 2 2 2 Shape "disk" Shape "sphere"
ObjectEnd
Shape "sphere"
ObjectInstance "leaf"
AttributeBegin Translate 5 0 0 ObjectInstance "leaf" AttributeEnd)");
  ASSERT_EQ(s.objects.size(), 1u);
  ASSERT_EQ(s.objects[0].shapes.size(), 2u);
  EXPECT_EQ(s.objects[0].name, "leaf");
  expect_near(s.objects[0].shapes[0].world_from_object.point({1, 0, 0}), {3, 0, 0});
  ASSERT_EQ(s.shapes.size(), 1u);
  EXPECT_EQ(s.shapes[0].material, 0u) << "ObjectEnd brings the state back";
  EXPECT_EQ(s.instances.objects, (std::vector<uint32_t>{0, 0}));
  EXPECT_EQ(s.instances.maps->at(1).rows, Transform::translate({6, 0, 0}).rows());
}

TEST(Parser, AttributeGivesDefaultsThatPluginsMayIgnore) {
  const SceneDescription s = parse_world(R"(
AttributeBegin
  Attribute "shape" "float alpha" .5 "float radius" 2
  Attribute "shape" "float alpha" .25
  Attribute "material" "float roughness" .1
  Attribute "light" "float scale" 3
  Attribute "texture" "float value" 4
  Shape "sphere" "float radius" 9
  Material "conductor" LightSource "point" AreaLightSource "diffuse" Texture "t" "float" "constant"
AttributeEnd
Shape "sphere")");
  const auto& params = s.shapes.at(0).plugin.params;
  ASSERT_EQ(params.size(), 2u);
  EXPECT_THAT(numbers(params[0]), ElementsAre(9));
  EXPECT_FALSE(params[0].may_be_unused);
  EXPECT_EQ(params[1].name, "alpha");
  EXPECT_THAT(numbers(params[1]), ElementsAre(0.25));
  EXPECT_TRUE(params[1].may_be_unused);
  EXPECT_EQ(s.materials.at(1).plugin.params.at(0).name, "roughness");
  EXPECT_EQ(s.lights.at(0).plugin.params.at(0).name, "scale");
  EXPECT_EQ(s.area_lights.at(0).params.at(0).name, "scale");
  EXPECT_EQ(s.textures.at(0).plugin.params.at(0).name, "value");
  EXPECT_TRUE(s.shapes.at(1).plugin.params.empty());
}

TEST(Parser, LimitsTheCopiesOfAttribute) {
  std::string world = "WorldBegin Attribute \"shape\" \"float x\" [";
  for (int i = 0; i < 1'000'000; ++i) world += " 1";
  world += "]\n";
  for (int i = 0; i < 100; ++i) world += "Shape \"sphere\"\n";
  const std::string error = error_of([&] { parse(world); });
  EXPECT_THAT(error, HasSubstr("s.pbrt:69:7: parameters by Attribute take more than 512 MB"));
  EXPECT_EQ(std::ranges::count(error, '\n'), 0) << "one error";

  // States share the parameters: only the directive copies them.
  std::string nested = "WorldBegin Attribute \"shape\" \"float x\" [";
  for (int i = 0; i < 100'000; ++i) nested += " 1";
  nested += "]\n";
  for (int i = 0; i < 10'000; ++i) nested += "AttributeBegin ";
  for (int i = 0; i < 10'000; ++i) nested += "AttributeEnd ";
  EXPECT_TRUE(parse(nested).shapes.empty());
}

TEST(Parser, WarnsOfAcceleratorsOptionsGivenTwiceAndLightsInObjects) {
  testing::internal::CaptureStderr();
  parse_scene_text(R"(Accelerator "bvh" Accelerator "octree" Film "rgb"
Film "rgb"
WorldBegin ObjectBegin "o" LightSource "point" ObjectEnd)",
                   "s.pbrt", ConsoleLog());
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "s.pbrt:1:31: warning: unknown accelerator \"octree\": Embree brings its own\n"
            "s.pbrt:2:6: warning: this Film takes the place of that at s.pbrt:1:45\n"
            "s.pbrt:3:40: warning: a light inside an object is not part of its instances: it shines once\n");
}

TEST(Parser, IncludesFilesBesideTheOneThatNamesThemOrBesideTheMainFile) {
  const TestFolder folder("include");
  folder.write("parts/a.pbrt", "Include \"b.pbrt\"\nInclude \"parts/c.pbrt\"\nAttributeBegin");
  folder.write("parts/b.pbrt", "Translate 1 0 0");
  folder.write("parts/c.pbrt", "\nShape \"sphere\"");
  const auto main = folder.write("main.pbrt", "WorldBegin Include \"parts/a.pbrt\" AttributeEnd Shape \"disk\"");
  const SceneDescription s = parse_scene(main, silent_log());
  ASSERT_EQ(s.shapes.size(), 2u);
  EXPECT_EQ(s.shapes[1].world_from_object, Transform::translate({1, 0, 0}));
  EXPECT_EQ(s.shapes[0].plugin.where.text(), folder.name_of("parts/c.pbrt") + ":2:7: ");
  ASSERT_EQ(s.files.size(), 4u);
  EXPECT_EQ(s.files[0], main);
  EXPECT_EQ(s.files[3], folder.name_of("parts/c.pbrt"));
}

TEST(Parser, ResolvesParentFoldersBehindALinkAsTheSystemDoes) {
  const TestFolder folder("link");
  const std::string text = "WorldBegin Include \"../parts/a.pbrt\"";
  folder.write("far/parts/a.pbrt", "Shape \"sphere\"");
  const auto main = folder.write("far/scene/main.pbrt", text);
  folder.write("near/unused.pbrt", "");
  std::filesystem::create_directory_symlink(main.parent_path(), folder.name_of("near/scene"));
  const std::filesystem::path through_link = folder.name_of("near/scene/main.pbrt");
  EXPECT_EQ(parse_scene(through_link, silent_log()).shapes.at(0).plugin.name, "sphere");
  // The target's parent goes first, as in pbrt; the folder with the link is second.
  folder.write("near/parts/a.pbrt", "Shape \"disk\"");
  EXPECT_EQ(parse_scene(through_link, silent_log()).shapes.at(0).plugin.name, "sphere");
  std::filesystem::remove(folder.name_of("far/parts/a.pbrt"));
  EXPECT_EQ(parse_scene(through_link, silent_log()).shapes.at(0).plugin.name, "disk");
  EXPECT_EQ(parse_scene(through_link, silent_log()).files.at(1), folder.name_of("near/parts/a.pbrt"));
}

TEST(Parser, HashesTheContentOfAllFilesAndNotTheirNames) {
  const TestFolder folder("hash");
  const auto main = folder.write("main.pbrt", "WorldBegin Include \"part.pbrt\"");
  folder.write("part.pbrt", "Shape \"sphere\"");
  const uint64_t before = parse_scene(main, silent_log()).content_hash;
  EXPECT_EQ(before, parse_scene(main, silent_log()).content_hash);
  EXPECT_EQ(parse("WorldBegin").content_hash, parse_scene_text("WorldBegin", "other", silent_log()).content_hash);
  folder.write("part.pbrt", "Shape \"disk\"");
  EXPECT_NE(before, parse_scene(main, silent_log()).content_hash);
}

TEST(Parser, PrintsTheChainOfAnIncludeCycle) {
  const TestFolder folder("cycle");
  const auto main = folder.write("main.pbrt", "WorldBegin\nInclude \"a.pbrt\"");
  folder.write("a.pbrt", "Include \"b.pbrt\"");
  folder.write("b.pbrt", "\n Include \"./a.pbrt\"");
  const std::string a = folder.name_of("a.pbrt"), b = folder.name_of("b.pbrt");
  EXPECT_EQ(error_of([&] { parse_scene(main, silent_log()); }),
            b + ":2:10: include cycle: " + a + " -> " + b + " -> " + a);
}

TEST(Parser, RefusesIncludesThatNestTooDeep) {
  const TestFolder folder("deep");
  const auto main = folder.write("0.pbrt", "Include \"1.pbrt\"");
  for (int i = 1; i <= 64; ++i) folder.write(fmt::format("{}.pbrt", i), fmt::format("Include \"{}.pbrt\"", i + 1));
  EXPECT_THAT(error_of([&] { parse_scene(main, silent_log()); }),
              HasSubstr("63.pbrt:1:9: includes are nested more than 64 deep"));
}

TEST(Parser, SaysWhatIsWrongWithFilesThatItCannotRead) {
  const TestFolder folder("missing");
  const auto main = folder.write("main.pbrt", "Include \"gone.pbrt\"");
  EXPECT_EQ(error_of([&] { parse_scene(main, silent_log()); }),
            main.string() + ":1:9: there is no file " + folder.name_of("gone.pbrt"));
  EXPECT_EQ(error_of([&] { parse_scene(folder.name_of("gone"), silent_log()); }),
            "there is no file " + folder.name_of("gone"));
  EXPECT_EQ(error_of([&] { parse_scene(folder.name_of("."), silent_log()); }),
            folder.name_of(".") + " is a folder, not a file");
}

}  // namespace
}  // namespace frond
