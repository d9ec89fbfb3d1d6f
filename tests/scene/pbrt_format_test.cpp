// Features of pbrt-v4's format: imports, compressed files, transforms that cannot be inverted, names of its plugins.
#include <gmock/gmock.h>
#include <zlib.h>

#include "core/log.h"
#include "core/messages/problems.h"
#include "render/plugins.h"
#include "scene/format/directives.h"
#include "scene/format/parser.h"
#include "scene/pbrt_plugins.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class KeptLog final : public Log {
 public:
  void info(std::string_view message) const override { infos.emplace_back(message); }
  void warn(const Location& where, std::string_view message) const override {
    warnings.push_back(where.text() + std::string(message));
  }
  mutable std::vector<std::string> infos, warnings;
};

SceneDescription parse_world_of_format(const std::string& text, const Log& log = silent_log()) {
  return parse_scene_text("WorldBegin\n" + text, "s", log);
}

std::string gzipped(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(text.size() + 100, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = uInt(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = uInt(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(packed.size() - stream.avail_out);
  deflateEnd(&stream);
  return packed;
}

TEST(PbrtFormat, ImportTakesTheStateInAndLetsNoneOut) {
  const TestFolder folder("import");
  folder.write("inner.pbrt",
               "Shape \"disk\" Translate 0 1 0 Material \"mix\" CoordinateSystem \"c\" ReverseOrientation\n"
               "AttributeBegin Shape \"sphere\" AttributeEnd\n"
               "MakeNamedMaterial \"m\" \"string type\" \"diffuse\"");
  const auto scene = parse_scene(folder.write("main.pbrt",
                                              "WorldBegin Translate 1 0 0\n"
                                              "Import \"inner.pbrt\" NamedMaterial \"m\" Shape \"disk\""),
                                 silent_log());
  ASSERT_EQ(scene.shapes.size(), 3u);
  EXPECT_EQ(scene.shapes[0].world_from_object, Transform::translate({1, 0, 0}));
  EXPECT_EQ(scene.shapes[1].world_from_object, Transform::translate({1, 1, 0}));
  EXPECT_EQ(scene.shapes[2].world_from_object, Transform::translate({1, 0, 0}));
  EXPECT_TRUE(scene.shapes[1].reverse_orientation);
  EXPECT_FALSE(scene.shapes[2].reverse_orientation);
  EXPECT_EQ(scene.materials[scene.shapes[2].material].name, "m");
  EXPECT_FALSE(scene.coordinate_systems.contains("c"));
}

TEST(PbrtFormat, WhatAnImportLeavesOpenIsToldThere) {
  const TestFolder folder("import_open");
  folder.write("inner.pbrt", "AttributeBegin");
  folder.write("ender.pbrt", "ObjectEnd");
  const auto error = [&](const std::string& text) {
    return error_of([&] { parse_scene(folder.write("main.pbrt", text), silent_log()); });
  };
  EXPECT_THAT(error("WorldBegin Import \"inner.pbrt\""), HasSubstr("inner.pbrt:1:1: AttributeBegin without"));
  EXPECT_THAT(error("WorldBegin ObjectBegin \"o\" Import \"ender.pbrt\" ObjectEnd"),
              HasSubstr("ObjectEnd while the Import at"));
}

TEST(PbrtFormat, CompressedFilesAreReadAsTheyAre) {
  const TestFolder folder("gz");
  folder.write("inner.pbrt.gz", gzipped("Translate 1 0 0 ") + gzipped("Shape \"disk\""));
  const std::string main = gzipped("WorldBegin Include \"inner.pbrt.gz\" Shape \"disk\"");
  const auto scene = parse_scene(folder.write("main.pbrt.gz", main), silent_log());
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(scene.shapes[1].world_from_object, Transform::translate({1, 0, 0}));
  folder.write("cut.pbrt", main.substr(0, main.size() / 2));
  EXPECT_THAT(error_of([&] { parse_scene(folder.name_of("cut.pbrt"), silent_log()); }), HasSubstr("cut short"));
}

TEST(PbrtFormat, ADirectiveMayEndInTheFileThatIncludes) {
  const TestFolder folder("over_the_end");
  folder.write("inner.pbrt", "Shape \"disk\"\n \"float radius\" 2");
  const auto scene =
      parse_scene(folder.write("main.pbrt", "WorldBegin Include \"inner.pbrt\"\n \"float height\" 3 Shape \"sphere\""),
                  silent_log());
  ASSERT_EQ(scene.shapes.size(), 2u);
  ASSERT_EQ(scene.shapes[0].plugin.params.size(), 2u);
  EXPECT_THAT(scene.shapes[0].plugin.params[0].where.text(), HasSubstr("inner.pbrt:2:2"));
  EXPECT_THAT(scene.shapes[0].plugin.params[1].where.text(), HasSubstr("main.pbrt:2:2"));
}

TEST(PbrtFormat, FilesAreFoundWithBackslashes) {
  const TestFolder folder("slashes");
  folder.write("geometry/inner.pbrt", "Shape \"disk\"");
  const auto main = folder.write("main.pbrt", R"(WorldBegin Include "geometry\\inner.pbrt")");
  EXPECT_EQ(parse_scene(main, silent_log()).shapes.size(), 1u);
}

TEST(PbrtFormat, TransformBeginSavesTheMaterialToo) {
  const KeptLog log;
  const auto scene =
      parse_world_of_format("TransformBegin Material \"mix\" Translate 1 0 0 TransformEnd Shape \"disk\"", log);
  EXPECT_EQ(scene.shapes.at(0).material, 0u);
  EXPECT_EQ(scene.shapes.at(0).world_from_object, Transform());
  EXPECT_THAT(log.warnings, ElementsAre(HasSubstr("s:2:1: TransformBegin saves all")));
}

TEST(PbrtFormat, WhatCannotBeInvertedIsLeftOut) {
  for (const char* flat :
       {"Scale 1 0 1", "Transform [ 1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1 ]", "Scale 1e-30 1 1 Scale 1e-30 1 1"}) {
    const KeptLog log;
    const auto scene =
        parse_world_of_format(std::string("ObjectBegin \"o\" Shape \"disk\" ObjectEnd AttributeBegin\n") + flat +
                                  "\nShape \"disk\" LightSource \"point\" ObjectInstance \"o\" Scale 2 2 2\n"
                                  "AttributeEnd Shape \"sphere\"",
                              log);
    EXPECT_EQ(scene.shapes.size(), 1u) << flat;
    EXPECT_THAT(scene.lights, IsEmpty());
    EXPECT_THAT(scene.instances.objects, IsEmpty());
    EXPECT_THAT(log.warnings, ElementsAre(HasSubstr("cannot be inverted")));
  }
}

TEST(PbrtFormat, WhatPbrtOnlyWarnsOfIsAWarning) {
  const std::vector<std::pair<std::string, std::string>> scenes{
      {"AttributeEnd", "s:2:1: AttributeEnd without AttributeBegin is left out"},
      {"TransformEnd", "s:2:1: TransformEnd without TransformBegin is left out"},
      {"CoordSysTransform \"wurld\"", "s:2:19: unknown coordinate system \"wurld\"; did you mean \"world\"?"},
      {"NamedMaterial \"m\"", "s:2:15: there is no named material \"m\""},
      {"Shape \"disk\" \"float radius\" 1 \"float radius\" 2", "s:2:31: parameter \"radius\" is given twice"}};
  for (const auto& [text, warning] : scenes) {
    const KeptLog log;
    parse_world_of_format(text, log);
    EXPECT_THAT(log.warnings, ElementsAre(HasSubstr(warning))) << text;
  }
  const auto scene = parse_world_of_format("Shape \"disk\" \"float radius\" 1 \"float radius\" 2");
  ASSERT_EQ(scene.shapes.at(0).plugin.params.size(), 1u);
  EXPECT_EQ(std::get<std::vector<double>>(scene.shapes[0].plugin.params[0].values)[0], 2);
}

TEST(PbrtFormat, AllErrorsAreToldAndNoneThatFollows) {
  Problems problems;
  problems.attempt([] {
    parse_world_of_format(
        "Shape sphere\nTranslate 1 2\nMakeNamedMaterial \"m\" \"flot x\" 1\nNamedMaterial \"m\" Shape \"disk\"\n"
        "Texture \"t\" \"color\" \"constant\"\nShape \"disk\" \"string a\" \"b\nFoo 1 2 3\nObjectInstance \"o\"");
  });
  EXPECT_THAT(
      problems.messages(),
      ElementsAre(HasSubstr("s:2:7: Shape needs"), HasSubstr("s:4:1: Translate takes"), HasSubstr("s:4:23: unknown"),
                  HasSubstr("s:6:13: unknown kind of texture"), HasSubstr("s:7:25: this string"),
                  HasSubstr("s:8:1: unknown directive Foo"), HasSubstr("s:9:16: there is no object")));
}

/// The one text stands before the other in memory, and behind it.
TEST(PbrtFormat, AfterAnErrorAtAnIncludedFilesEndTheFileThatIncludesGoesOn) {
  const std::string inner_text = "Translate 1 x", outer_text = "Include \"i\" Shape \"disk\"";
  for (const std::string& both : {inner_text + ' ' + outer_text, outer_text + ' ' + inner_text}) {
    const auto piece = [&](const std::string& text) {
      return std::string_view(both).substr(both.find(text), text.size());
    };
    const auto name = std::make_shared<const std::string>("s");
    Tokenizer outer(piece(outer_text), name);
    outer.next(), outer.next();
    Tokenizer inner(piece(inner_text), name, &outer);
    const Token failed = inner.next();
    inner.next(), inner.next();
    inner.skip_to_directive(failed, is_directive);
    EXPECT_EQ(outer.peek().text, "Shape") << both;
  }
}

TEST(PbrtFormat, WhatAnIncludedFileTakesOfItsIncluderIsReadAgain) {
  const TestFolder folder("include_end");
  folder.write("inner.pbrt", "Shape \"disk\"\nTranslate 1 2");
  Problems problems;
  const auto scene =
      parse_scene({folder.write("main.pbrt", "WorldBegin\nInclude \"inner.pbrt\"\nShape \"sphere\"\nFoo 1")},
                  silent_log(), problems);
  EXPECT_THAT(problems.messages(), ElementsAre(HasSubstr("main.pbrt:3:1: Translate takes 3 numbers"),
                                               HasSubstr("main.pbrt:4:1: unknown directive Foo")));
  EXPECT_EQ(scene.shapes.size(), 2u);
}

TEST(PbrtFormat, FilesAreRelativeToTheMainFileFirst) {
  const TestFolder folder("relative");
  folder.write("a.pbrt", "Shape \"disk\"");
  folder.write("sub/a.pbrt", "Shape \"sphere\"");
  folder.write("sub/b.pbrt", "Shape \"sphere\"");
  folder.write("sub/inner.pbrt", "Include \"a.pbrt\" Include \"b.pbrt\"");
  const auto scene = parse_scene(folder.write("main.pbrt", "WorldBegin Include \"sub/inner.pbrt\""), silent_log());
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(scene.shapes[0].plugin.name, "disk");
  EXPECT_EQ(scene.shapes[1].plugin.name, "sphere");
}

TEST(PbrtFormat, CommentsEndWithALineOfAnyKind) {
  EXPECT_EQ(parse_world_of_format("# one\rShape \"disk\"\r# two\r\nShape \"disk\"").shapes.size(), 2u);
  EXPECT_THAT(error_of([] { parse_world_of_format("# one\r\r Foo"); }), HasSubstr("s:4:2: unknown directive Foo"));
}

TEST(PbrtFormat, AMissingIncludeIsTheOnlyError) {
  const TestFolder folder("missing");
  for (const char* text :
       {"Include \"none.pbrt\" Shape \"disk\" NamedMaterial \"m\" Shape \"disk\"",
        "WorldBegin Include \"none.pbrt\" NamedMaterial \"m\" Shape \"disk\" ObjectInstance \"o\" ObjectEnd",
        "WorldBegin Import \"none.pbrt\" NamedMaterial \"m\" Shape \"disk\" ObjectInstance \"o\""}) {
    Problems problems;
    parse_scene({folder.write("main.pbrt", text)}, silent_log(), problems);
    EXPECT_THAT(problems.messages(), ElementsAre(HasSubstr("none.pbrt"))) << text;
  }
}

TEST(PbrtFormat, WhatARefusedObjectHoldsIsNotInTheWorld) {
  const TestFolder folder("refused_object");
  Problems problems;
  const auto scene =
      parse_scene({folder.write("main.pbrt",
                                "WorldBegin ObjectBegin \"o\" ObjectEnd ObjectBegin \"o\" Shape \"disk\" ObjectEnd\n"
                                "ObjectBegin \"p\" ObjectBegin \"q\" Shape \"disk\" ObjectEnd ObjectEnd\n"
                                "ObjectBegin 3 Shape \"disk\" ObjectEnd ObjectInstance \"o\"")},
                  silent_log(), problems);
  EXPECT_THAT(problems.messages(),
              ElementsAre(HasSubstr("object \"o\" is defined again"), HasSubstr("ObjectBegin inside object \"p\""),
                          HasSubstr("ObjectBegin needs a quoted name")));
  EXPECT_THAT(scene.shapes, IsEmpty());
}

TEST(PbrtFormat, WorldBeginMakesAllTransformsActive) {
  const auto scene =
      parse_scene_text("ActiveTransform EndTime WorldBegin Translate 1 0 0 Shape \"disk\"", "s", silent_log());
  EXPECT_EQ(scene.shapes.at(0).world_from_object, Transform::translate({1, 0, 0}));
}

TEST(PbrtFormat, ActiveTransformMovesShapesAndInstances) {
  const KeptLog log;
  const auto scene = parse_scene_text(
      "Translate 0 0 9 ActiveTransform EndTime Translate 0 1 0 Camera \"perspective\" TransformTimes 2 4 WorldBegin\n"
      "AttributeBegin ActiveTransform EndTime Translate 1 0 0 Shape \"disk\" LightSource \"point\" AttributeEnd\n"
      "ObjectBegin \"o\" Shape \"disk\" ObjectEnd ActiveTransform StartTime Translate 2 0 0 ActiveTransform All\n"
      "Scale 2 2 2 ObjectInstance \"o\" CoordSysTransform \"camera\" Identity ObjectInstance \"o\"",
      "s", log);
  const auto x_of = [](const AffineMap& map) { return map.point({1, 0, 0}).x; };
  EXPECT_EQ(scene.transform_times, (std::array<double, 2>{2, 4}));
  EXPECT_EQ(scene.camera_from_world.at_end(), Transform::translate({0, 1, 9}));
  EXPECT_THAT(scene.shapes, IsEmpty());
  ASSERT_EQ(scene.instances.moving.size(), 2u);
  const MovingInstance &shape = scene.instances.moving[0], &object = scene.instances.moving[1];
  EXPECT_EQ(scene.objects.at(shape.object).name, "");
  EXPECT_EQ(scene.objects.at(shape.object).shapes.at(0).world_from_object, Transform());
  EXPECT_EQ(x_of(shape.start), 1);
  EXPECT_EQ(x_of(shape.end), 2);
  EXPECT_EQ(scene.objects.at(object.object).name, "o");
  EXPECT_EQ(x_of(object.start), 4);
  EXPECT_EQ(x_of(object.end), 2);
  EXPECT_EQ(scene.instances.objects.size(), 1u);  // Identity ends the motion
  EXPECT_THAT(log.warnings, ElementsAre(HasSubstr("a light does not move")));
}

TEST(PbrtFormat, OptionsMayStandInTheWorld) {
  EXPECT_EQ(parse_world_of_format("Option \"integer seed\" 3").options.size(), 1u);
}

/// A scene after the replacement of pbrt's plug-ins, and its messages.
struct Answer {
  SceneDescription scene;
  Problems problems;
  KeptLog log;
};

Answer answer(const std::string& text, const std::string& ignored = "") {
  Answer result;
  const auto unsupported = ignored.empty() ? Unsupported() : Unsupported(ignored);
  const Registry registry = builtin_registry();
  result.problems.attempt([&] {
    result.scene = parse_scene_text(text, "s", result.log);
    translate_pbrt_plugins(result.scene, registry, unsupported, result.log, result.problems);
  });
  return result;
}

TEST(PbrtFormat, SamplersAreAnsweredByOurs) {
  for (const char* name : {"halton", "sobol", "zsobol", "pmj02bn", "paddedsobol"}) {
    const Answer a = answer(fmt::format("Sampler \"{}\" \"integer pixelsamples\" 9 WorldBegin", name));
    EXPECT_EQ(a.scene.sampler.name, "lattice");
    EXPECT_EQ(a.scene.sampler.params.size(), 1u);
    EXPECT_TRUE(a.problems.empty() && a.log.warnings.empty());
  }
  const Answer a =
      answer("Sampler \"stratified\" \"integer xsamples\" 3 \"integer ysamples\" 5 \"bool jitter\" true WorldBegin");
  ASSERT_EQ(a.scene.sampler.params.size(), 1u);
  EXPECT_EQ(std::get<std::vector<double>>(a.scene.sampler.params[0].values)[0], 15);
  EXPECT_EQ(answer("Sampler \"zsobol\" \"string randomization\" \"owen\" WorldBegin").scene.sampler.params.size(), 0u);
}

TEST(PbrtFormat, ANamedMaterialWithoutTypeIsOneError) {
  Problems problems;
  const TestFolder folder("untyped");
  const Registry registry = builtin_registry();
  auto scene = parse_scene({folder.write("main.pbrt",
                                         "WorldBegin MakeNamedMaterial \"m\" NamedMaterial \"m\"\n"
                                         "Shape \"disk\"")},
                           silent_log(), problems);
  translate_pbrt_plugins(scene, registry, {}, silent_log(), problems);
  for (const MaterialDescription& m : scene.materials) EXPECT_TRUE(registry.materials.find(m.plugin.name));
  EXPECT_THAT(problems.messages(), ElementsAre(HasSubstr("needs parameter \"string type\"")));
}

TEST(PbrtFormat, AttributesThatNothingTakesAreWarnedOf) {
  const Answer a = answer(
      "WorldBegin\nAttribute \"shape\" \"float radious\" 1 \"float radius\" 2\n"
      "Attribute \"material\" \"string normalmap\" \"n.png\" Attribute \"light\" \"float L\" 1");
  EXPECT_THAT(a.log.warnings, ElementsAre(HasSubstr("s:2:19: no shape has a parameter \"radious\"; did you mean "
                                                    "\"radius\"?")));
}

TEST(PbrtFormat, VolpathIsPathWhereThereAreNoMedia) {
  const Answer a = answer("Integrator \"volpath\" \"integer maxdepth\" 7 \"bool regularize\" true WorldBegin");
  EXPECT_EQ(a.scene.integrator.name, "path");
  EXPECT_EQ(a.scene.integrator.params.size(), 2u);
  EXPECT_TRUE(a.problems.empty());
  EXPECT_THAT(a.log.warnings, IsEmpty());
}

TEST(PbrtFormat, VolpathSeesThroughInterfaces) {
  const std::string world = " WorldBegin Material \"interface\" Shape \"sphere\" Material \"diffuse\" Shape \"disk\"";
  EXPECT_EQ(answer("Integrator \"volpath\"" + world).scene.shapes.size(), 1u);
  EXPECT_EQ(answer(world).scene.shapes.size(), 1u);  // pbrt's default
  EXPECT_EQ(answer("Integrator \"path\"" + world).scene.shapes.size(), 2u);
}

TEST(PbrtFormat, ScenesWithMediaAreForVolpath) {
  const std::string media =
      " WorldBegin MakeNamedMedium \"m\" \"string type\" \"homogeneous\" MediumInterface \"m\" \"\" Material "
      "\"interface\" Shape \"sphere\"";
  for (const char* name : {"volpath", "bdpt", "mlt", "sppm", "lightpath", "simplevolpath"}) {
    const std::string integrator = fmt::format("Integrator \"{}\"", name);
    EXPECT_EQ(answer(integrator + media).scene.integrator.name, "volpath") << name;
    EXPECT_EQ(answer(integrator + media).scene.shapes.size(), 1u) << name;
    const Answer without = answer(integrator + " WorldBegin");
    EXPECT_EQ(without.scene.integrator.name, "path") << name;
    EXPECT_THAT(without.log.warnings, ElementsAre()) << name;
  }
  EXPECT_EQ(answer(media).scene.integrator.name, "volpath");
  EXPECT_EQ(answer("Integrator \"path\"" + media).scene.integrator.name, "path");
  EXPECT_THAT(answer("Integrator \"ambientocclusion\" WorldBegin").log.warnings,
              ElementsAre(HasSubstr("whose image is another")));
}

TEST(PbrtFormat, WhatGivesAnotherImageHasToBeLetPass) {
  const std::string text =
      "Integrator \"bdpt\" Camera \"realistic\" \"string lensfile\" \"x.dat\" WorldBegin\n"
      "Texture \"t\" \"float\" \"ptex\" \"string filename\" \"x.ptx\"\n"
      "Shape \"disk\"";
  const Answer refused = answer(text);
  EXPECT_EQ(refused.problems.count(), 2u);
  const Answer passed = answer(text, "all");
  EXPECT_TRUE(passed.problems.empty());
  EXPECT_EQ(passed.log.warnings.size(), 2u);
  EXPECT_EQ(passed.scene.integrator.name, "path");
  EXPECT_EQ(passed.scene.camera.name, "perspective");
  EXPECT_EQ(passed.scene.shapes.at(0).world_from_object, Transform());
  const Answer some = answer(text, "textures");
  EXPECT_EQ(some.problems.count(), 1u);
  EXPECT_THAT(some.problems.messages()[0], HasSubstr("s:1:26: Camera \"realistic\" of pbrt-v4 is not supported; with "
                                                     "--ignore-unsupported=cameras it is replaced by \"perspective\""));
  EXPECT_THAT(error_of([] { Unsupported("fog"); }), HasSubstr("--ignore-unsupported takes all, or some of materials"));
}

TEST(PbrtFormat, DisplacedMeshesHaveToBeLetPass) {
  const std::string text =
      "WorldBegin Shape \"plymesh\" \"string filename\" \"x.ply\" \"float edgelength\" .1 \"texture displacement\" "
      "\"t\"";
  EXPECT_EQ(answer(text).problems.count(), 1u);
  const Answer passed = answer(text, "displacement");
  EXPECT_TRUE(passed.problems.empty());
  EXPECT_EQ(passed.scene.shapes.at(0).plugin.params.size(), 1u);
}

TEST(PbrtFormat, FilesOfOlderVersionsAreKnown) {
  const Answer a =
      answer("Film \"image\" Sampler \"lowdiscrepancy\" WorldBegin Material \"matte\" \"rgb Kd\" 1 Shape \"cone\"");
  ASSERT_EQ(a.problems.count(), 1u);
  EXPECT_THAT(a.problems.messages()[0], HasSubstr("s:1:22: Sampler \"lowdiscrepancy\": this is a file for pbrt-v3"));
  EXPECT_THAT(a.problems.messages()[0], HasSubstr("pbrt --upgrade"));
}

}  // namespace
}  // namespace frond
