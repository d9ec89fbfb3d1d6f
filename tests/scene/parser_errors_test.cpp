#include <gmock/gmock.h>

#include "core/log.h"
#include "core/math/random.h"
#include "scene/format/parser.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

struct BadScene {
  std::string text, error;
};

/// The whole message, place included.
void expect_errors(const std::vector<BadScene>& scenes) {
  for (const auto& [text, error] : scenes)
    EXPECT_EQ(error_of([&text = text] { parse_scene_text(text, "s", silent_log()); }), error) << text;
}

/// The text stands on the second line, inside the world.
void expect_errors_in_world(std::vector<BadScene> scenes) {
  for (BadScene& scene : scenes) scene.text = "WorldBegin\n" + scene.text;
  expect_errors(scenes);
}

TEST(ParserErrors, NameWhatIsNotText) {
  expect_errors({
      {std::string("WorldBegin\n ab\0c", 16), "s:2:4: a zero byte: this is not a text file"},
      {"\x1f\x8b\x08...", "s:1:1: s is compressed and damaged: unknown header flags set"},
      {std::string("\xff\xfe") + "W", "s:1:1: this file is UTF-16 text; scene files are UTF-8"},
      {"\x7f\x80", "s:1:1: unknown directive \\x7f\x80"},
  });
}

TEST(ParserErrors, NameUnknownDirectives) {
  expect_errors({
      {"WorldBeginn", "s:1:1: unknown directive WorldBeginn; did you mean WorldBegin?"},
      {"  Inclde \"a\"", "s:1:3: unknown directive Inclde; did you mean Include?"},
      {"WorldBegin xyzzy", "s:1:12: unknown directive xyzzy"},
      {"Camera \"perspective\" 12", "s:1:22: a directive is needed, 12 was given"},
      {"WorldBegin ]", "s:1:12: a directive is needed, ] was given"},
      {"WorldBegin \"sphere\"", "s:1:12: a directive is needed, \"sphere\" was given"},
      {"WorldBegin Translate 1 2 3 4", "s:1:28: a directive is needed, 4 was given"},
  });
}

TEST(ParserErrors, NameWhatOfPbrtIsNotThereYet) {
  expect_errors({
      {"ActiveTransform Now", "s:1:17: ActiveTransform takes StartTime, EndTime or All, Now was given"},
      {"Import \"x\"", "s:1:1: Import belongs after WorldBegin"},
      {"WorldBegin WorldEnd",
       "s:1:12: WorldEnd: this is a file for pbrt-v3 or older; \"pbrt --upgrade\" of pbrt-v4 makes one for pbrt-v4"},
  });
}

TEST(ParserErrors, TellWhichBlockADirectiveBelongsTo) {
  for (const char* name : {"Accelerator", "Camera", "Film", "Integrator", "PixelFilter", "Sampler"})
    expect_errors_in_world({{fmt::format("{} \"x\"", name), fmt::format("s:2:1: {} belongs before WorldBegin", name)}});
  for (const char* name :
       {"AreaLightSource", "AttributeBegin", "AttributeEnd", "LightSource", "MakeNamedMaterial", "Material",
        "NamedMaterial", "ObjectBegin", "ObjectEnd", "ObjectInstance", "ReverseOrientation", "Shape", "Texture"})
    expect_errors({{name, fmt::format("s:1:1: {} belongs after WorldBegin", name)}});
  expect_errors({
      {"WorldBegin\n WorldBegin", "s:2:2: WorldBegin is given twice"},
      {"", "s:1:1: the file ends before WorldBegin"},
      {"Film \"rgb\"\n# nothing more\n", "s:3:1: the file ends before WorldBegin"},
  });
}

TEST(ParserErrors, TellWhatIsNotNestedAsItShouldBe) {
  expect_errors_in_world({
      {"ObjectEnd", "s:2:1: ObjectEnd without ObjectBegin"},
      {"AttributeBegin\nObjectEnd", "s:3:1: ObjectEnd without ObjectBegin"},
      {"ObjectBegin \"a\" AttributeEnd", "s:2:17: AttributeEnd while the ObjectBegin at s:2:13 is open"},
      {"ObjectBegin \"a\" AttributeBegin ObjectEnd", "s:2:32: ObjectEnd while the AttributeBegin at s:2:17 is open"},
      {"ObjectBegin \"a\" ObjectBegin \"b\"",
       "s:2:29: ObjectBegin inside object \"a\"; ObjectInstance places one object in another"},
      {"ObjectBegin \"a\" ObjectEnd\nObjectBegin \"a\"", "s:3:13: object \"a\" is defined again; first at s:2:13"},
      {"\nAttributeBegin AttributeBegin AttributeEnd", "s:3:1: AttributeBegin without AttributeEnd"},
      {"\nObjectBegin \"a\"", "s:3:13: ObjectBegin without ObjectEnd"},
  });
}

TEST(ParserErrors, TellWhichNameIsUnknownOrDefinedAgain) {
  const std::string leaf = "MakeNamedMaterial \"leaf\" \"string type\" \"abm\"\n";
  expect_errors_in_world({
      {leaf + "NamedMaterial \"leef\" Shape \"disk\"",
       "s:3:15: there is no named material \"leef\"; did you mean \"leaf\"?"},
      {"NamedMaterial \"leaf\" Shape \"disk\"",
       "s:2:15: there is no named material \"leaf\"; MakeNamedMaterial makes them"},
      {leaf + leaf, "s:3:19: material \"leaf\" is defined again"},
      {"MakeNamedMaterial \"m\"", "s:2:19: MakeNamedMaterial \"m\" needs parameter \"string type\""},
      {"MakeNamedMaterial \"m\" \"float type\" 1", "s:2:23: \"type\" is string, type float was given"},
      {"MakeNamedMaterial \"m\" \"string type\" [\"a\" \"b\"]", "s:2:38: \"type\" takes 1 value, 2 given"},
      {"ObjectBegin \"leaf\" ObjectEnd\nObjectInstance \"leave\"",
       "s:3:16: there is no object \"leave\"; did you mean \"leaf\"?"},
      {"Texture \"t\" \"color\" \"constant\"", "s:2:13: unknown kind of texture \"color\"; there are float, spectrum"},
      {"Texture \"t\" \"float\" \"scale\"\nTexture \"t\" \"float\" \"mix\"",
       "s:3:9: float texture \"t\" is defined again; first at s:2:9"},
      {"Attribute \"shapes\"", "s:2:11: unknown target \"shapes\" of Attribute; did you mean \"shape\"?"},
  });
}

TEST(ParserErrors, TellWhichTransformMakesNoSense) {
  expect_errors_in_world({
      {"Rotate 30 0 0 0", "s:2:1: Rotate about the axis 0 0 0"},
      {"LookAt 1 2 3 1 2 3 0 1 0", "s:2:1: LookAt: eye and target are the same point"},
      {"LookAt 0 0 0 0 2 0 0 1 0", "s:2:1: LookAt: up is parallel to the direction of view"},
      {"LookAt 0 0 0 0 2 0 0 0 0", "s:2:1: LookAt: up is 0 0 0"},
      {"Transform [ 1 0 0 0 0 1 0 0 0 0 1 .5 0 0 0 1 ]",
       "s:2:1: Transform: the matrix is projective (its last row is 0 0 0.5 1, not 0 0 0 1)"},
      {"Transform 1 0 0", "s:2:11: Transform takes 16 numbers in brackets, 1 was given"},
      {"Transform [ 1 0 0 ]", "s:2:19: Transform takes 16 numbers: a number is needed, ] was given"},
      {"Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 1 ]",
       "s:2:45: Transform takes 16 numbers in brackets, 1 was given"},
      {"Translate 1 2\nShape \"disk\"", "s:3:1: Translate takes 3 numbers: a number is needed, Shape was given"},
      {"Translate [ 1 2 3 ]", "s:2:11: Translate takes 3 numbers: a number is needed, [ was given"},
      {"Translate 1 2", "s:2:14: Translate takes 3 numbers: a number is needed, the end of the file was given"},
      {"Translate 1 nan 0", "s:2:13: Translate takes 3 numbers: a number is needed, nan was given"},
      {"Translate 1 -inf 0", "s:2:13: Translate takes 3 numbers: a number is needed, -inf was given"},
      {"Translate 1 1e99 0", "s:2:13: 1e99 is out of range: numbers reach 3.403e+38"},
  });
}

TEST(ParserErrors, TellWhichParameterIsNotWellFormed) {
  expect_errors_in_world({
      {"Shape sphere", "s:2:7: Shape needs a quoted name, sphere was given"},
      {"Shape", "s:2:6: Shape needs a quoted name, the end of the file was given"},
      {"Shape \"disk\" \"flot radius\" 1", "s:2:14: unknown parameter type \"flot\"; did you mean \"float\"?"},
      {"Shape \"disk\" \"radius\" 1", "s:2:14: parameter \"radius\" has no type, as in \"float radius\""},
      {"Shape \"disk\" \"\" 1",
       "s:2:14: \"\" declares no parameter; a type and a name are needed, as in \"float scale\""},
      {"Shape \"disk\" \"float a b\" 1",
       "s:2:14: \"float a b\" declares no parameter; a type and a name are needed, as in \"float scale\""},
      {"Shape \"disk\" \"float a\"", "s:2:14: parameter \"a\" has no value"},
      {"Shape \"disk\" \"float a\" \"float b\" 1", "s:2:24: \"a\" is float: a number is needed, \"float b\" was given"},
      {"Shape \"disk\" \"float a\" [ 1 \"x\" ]", "s:2:28: \"a\" is float: a number is needed, \"x\" was given"},
      {"Shape \"disk\" \"float a\" nan", "s:2:24: \"a\" is float: a number is needed, nan was given"},
      {"Shape \"disk\" \"float a\" -inf", "s:2:24: \"a\" is float: a number is needed, -inf was given"},
      {"Shape \"disk\" \"float a\" 1.2.3", "s:2:24: \"a\" is float: a number is needed, 1.2.3 was given"},
      {"Shape \"disk\" \"float a\" 0x10", "s:2:24: \"a\" is float: a number is needed, 0x10 was given"},
      {"Shape \"disk\" \"float a\" +-1", "s:2:24: \"a\" is float: a number is needed, +-1 was given"},
      {"Shape \"disk\" \"float a\" 1e400", "s:2:24: 1e400 is out of range: numbers reach 3.403e+38"},
      {"Shape \"disk\" \"float a\" true", "s:2:24: \"a\" is float: a number is needed, true was given"},
      {"Shape \"disk\" \"float a\" ]", "s:2:24: \"a\" is float: a number is needed, ] was given"},
      {"Shape \"disk\" \"integer a\" [ 1 2.5 ]", "s:2:30: \"a\" is integer: an integer is needed, 2.5 was given"},
      {"Shape \"disk\" \"integer a\" 3000000000",
       "s:2:26: \"a\" is 3000000000, outside the range of integers, -2147483648 to 2147483647"},
      {"Shape \"disk\" \"bool a\" 1", "s:2:23: \"a\" is bool: true or false is needed, 1 was given"},
      {"Shape \"disk\" \"bool a\" \"yes\"", "s:2:23: \"a\" is bool: true or false is needed, \"yes\" was given"},
      {"Shape \"disk\" \"string a\" b", "s:2:25: \"a\" is string: a quoted string is needed, b was given"},
      {"Shape \"disk\" \"texture a\" 1", "s:2:26: \"a\" is texture: a quoted string is needed, 1 was given"},
      {"Shape \"disk\" \"spectrum a\" D65",
       "s:2:27: \"a\" is spectrum: a number or a quoted string is needed, D65 was given"},
      {"Shape \"disk\" \"spectrum a\" [ 400 \"x\" ]", "s:2:33: \"a\" is spectrum: a number is needed, \"x\" was given"},
      {"Shape \"disk\" \"spectrum a\" [ \"x\" 400 ]",
       "s:2:33: \"a\" is spectrum: a quoted string is needed, 400 was given"},
      {"Shape \"disk\" \"float a\" [ 1 [ 2 ] ]", "s:2:28: \"a\" is float: a number is needed, [ was given"},
      {"Shape \"disk\" \"float a\" [ 1\n2\nShape \"disk\"", "s:2:24: this [ is not closed before Shape"},
      {"Shape \"disk\" \"float a\" [ 1\n2\n", "s:2:24: this [ is not closed before the end of the file"},
      {"Shape \"disk\" \"string a\" \"abc\nd\"", "s:2:25: this string has no closing quote on its line"},
      {"Shape \"disk\" \"string a\" \"abc", "s:2:25: this string has no closing quote on its line"},
      {"Shape \"disk\" \"string a\" \"abc\\\"", "s:2:25: this string has no closing quote on its line"},
      {"Shape \"disk\" \"string a\" \"a\\qb\"", "s:2:25: \"\\q\" is not an escape in a string"},
      {"Include", "s:2:8: Include needs a quoted name, the end of the file was given"},
  });
}

TEST(ParserErrors, NameOptionsThatAreNotWellFormed) {
  expect_errors({
      {"Option seed 1", "s:1:8: a quoted name is needed, seed was given"},
      {"Option \"seed\"", "s:1:8: parameter \"seed\" has no value"},
      {"Option \"integer seed\" \"a\"", "s:1:23: \"seed\" is integer: an integer is needed, \"a\" was given"},
      {"Option \"seed\" maybe", "s:1:15: \"seed\" takes a number, true, false or a quoted string, maybe was given"},
  });
}

TEST(ParserErrors, ShortenWhatIsTooLongToShow) {
  const std::string forty(40, 'x');
  expect_errors_in_world({{forty + "xxxx", "s:2:1: unknown directive " + forty + "..."}});
}

constexpr std::string_view kGood = R"(# a scene with a bit of everything
LookAt 0 0 5  0 0 0  0 1 0 Camera "perspective" "float fov" [ 40 ]
Film "rgb" "integer xresolution" 64 Option "seed" 3 ColorSpace "srgb"
WorldBegin
Texture "t" "float" "constant" "float value" .5
MakeNamedMaterial "leaf" "string type" "abm" "bool weighted" true
AttributeBegin Attribute "shape" "float alpha" 1
  AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] Rotate 90 1 0 0 Scale 1 2 3
  Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1e-1 0 ] "integer indices" [ 0 1 2 ]
AttributeEnd
ObjectBegin "o" NamedMaterial "leaf" Shape "disk" "string name" "a\tb\"c" ObjectEnd
ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 -3 1 ] ObjectInstance "o"
CoordinateSystem "c" CoordSysTransform "c" ReverseOrientation LightSource "point" "spectrum I" "stdillum-D65"
)";

/// Parses or throws InputError; any other exception fails the test.
void parse_anything(const std::string& text) {
  error_of([&] { parse_scene_text(text, "fuzz", silent_log()); });
}

TEST(ParserErrors, EveryPieceOfASceneParsesOrIsRefused) {
  ASSERT_EQ(error_of([] { parse_scene_text(std::string(kGood), "good", silent_log()); }), "");
  for (size_t length = 0; length <= kGood.size(); ++length) {
    parse_anything(std::string(kGood.substr(0, length)));
    parse_anything("WorldBegin " + std::string(kGood.substr(length)));
  }
}

TEST(ParserErrors, ASceneWithAnyByteChangedParsesOrIsRefused) {
  RandomStream rng(1);
  for (size_t i = 0; i < kGood.size(); ++i) {
    std::string text(kGood);
    for (const char c : {' ', '"', '[', ']', '#', '0', '-', '\n', '\\'}) text[i] = c, parse_anything(text);
    for (int k = 0; k < 8; ++k) text[i] = static_cast<char>(rng.bits()), parse_anything(text);
  }
}

/// Each file includes the next one twice: 2^40 files in all.
TEST(ParserErrors, FilesThatAreIncludedAgainHaveALimitInAll) {
  const TestFolder folder("includes");
  for (int i = 0; i < 40; ++i)
    folder.write(fmt::format("{}.pbrt", i), fmt::format("Include \"{}.pbrt\"\nInclude \"{}.pbrt\"\n", i + 1, i + 1));
  folder.write("40.pbrt", "Scale 1 1 1\n");
  EXPECT_THAT(error_of([&] { parse_scene(folder.name_of("0.pbrt"), silent_log()); }),
              testing::HasSubstr("includes files again with more than 1 GB in all, each counted as 32 kB or more"));
}

TEST(ParserErrors, AnyNumberOfFilesIsIncludedOnce) {
  const TestFolder folder("many");
  std::string text;
  for (int i = 0; i < 20'100; ++i) {
    folder.write(fmt::format("{}.pbrt", i), "\n");
    text += fmt::format("Include \"{}.pbrt\"\n", i);
  }
  folder.write("all.pbrt", text + "WorldBegin\n");
  EXPECT_EQ(parse_scene(folder.name_of("all.pbrt"), silent_log()).files.size(), 20'101u);
}

/// Once took time quadratic in their number: 30,000 took 15 s, a million would have taken hours.
TEST(ParserErrors, AMillionRepeatedParametersAreRead) {
  std::string text = "Camera \"perspective\"";
  for (int i = 0; i < 1'000'000; ++i) text += " \"float a\" 1";
  EXPECT_EQ(error_of([&] { parse_scene_text(text + " WorldBegin", "s", silent_log()); }), "");
}

/// Names of millions of letters are neither compared letter by letter with all that exist nor printed whole.
TEST(ParserErrors, LongNamesAreShortened) {
  const std::string error = error_of([] { parse_scene_text("Wor" + std::string(10'000'000, 'd'), "s", silent_log()); });
  EXPECT_THAT(error, testing::HasSubstr("unknown directive Word"));
  EXPECT_LT(error.size(), 5000u);
}

}  // namespace
}  // namespace frond
