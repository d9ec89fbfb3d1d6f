// Options of pbrt-v4, `frond check`, --strict and --ignore-unsupported.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "image/image_file.h"
#include "tests/support/command_test.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr std::string_view kOptions =
    "LookAt 0 0 3 0 0 0 0 1 0 Camera \"perspective\" Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" "
    "6\n";
constexpr std::string_view kWorld = "WorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\n";

class PbrtOptions : public CommandTest {
 protected:
  void SetUp() override {
    folder_.write("scene.pbrt", std::string(kOptions) + std::string(kWorld));
    folder_.write("bad.pbrt", std::string(kOptions) + "Sampler \"zobol\"\n" + std::string(kWorld) +
                                  "Shape \"sphere\" \"float radus\" 1\nTranslate 1 2\n"
                                  "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"disk\"\n");
    std::string other(kOptions);
    other.replace(other.find("perspective"), std::strlen("perspective"), "realistic");
    folder_.write("other.pbrt", other + std::string(kWorld) + "Texture \"t\" \"float\" \"ptex\"\n");
  }
};

TEST_F(PbrtOptions, ASceneAloneIsRendered) {
  EXPECT_EQ(frond_command({path("scene.pbrt"), "--outfile", path("a.exr"), "--spp", "1", "--quiet"}).code, 0);
  EXPECT_EQ(frond_command({"--nthreads", "1", "--spp", "1", "--outfile", path("b.exr"), path("scene.pbrt")}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(path("a.exr")) && std::filesystem::exists(path("b.exr")));
}

TEST_F(PbrtOptions, WhatDoesNothingHereWarnsAndWhatAsksForMoreIsRefused) {
  const Outcome idle = frond_command(
      {"render", path("scene.pbrt"), "-o", path("a.exr"), "--spp", "1", "--gpu", "--stats", "--write-partial-images"});
  EXPECT_EQ(idle.code, 0);
  EXPECT_THAT(idle.err, AllOf(HasSubstr("--gpu of pbrt has no effect"), HasSubstr("--write-partial-images of pbrt")));
  const Outcome refused = frond_command({"render", path("scene.pbrt"), "--mse-reference-image", "a.exr"});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, HasSubstr("--mse-reference-image: frond difference compares"));
}

TEST_F(PbrtOptions, CropsTheWrongWayRoundArePutRight) {
  const Outcome done =
      frond_command({"render", path("scene.pbrt"), "-o", path("a.exr"), "--spp", "1", "--cropwindow", "0.5,0,0,0.5"});
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("wrong way round: taken for 0,0.5,0,0.5"));
  folder_.write("crop.pbrt",
                "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6\n"
                "\"integer pixelbounds\" [ 6 2 0 3 ]\n" +
                    std::string(kWorld));
  EXPECT_THAT(frond_command({path("crop.pbrt"), "-o", path("b.exr"), "--spp", "1"}).err,
              HasSubstr("crop.pbrt:2:25: warning: \"pixelbounds\" has its ends"));
}

TEST_F(PbrtOptions, PiecesAreOneSceneAndScenesFollowEachOther) {
  folder_.write("options.pbrt", kOptions);
  folder_.write("world.pbrt", kWorld);
  EXPECT_EQ(frond_command({path("options.pbrt"), path("world.pbrt"), "-o", path("a.exr"), "--spp", "1", "-q"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(path("a.exr")));
  EXPECT_THAT(frond_command({path("scene.pbrt"), path("scene.pbrt"), "-o", path("b.exr")}).err,
              HasSubstr("2 scenes cannot all be written to"));
  EXPECT_THAT(frond_command({"check", path("scene.pbrt"), path("scene.pbrt")}).out,
              HasSubstr("scene.pbrt: no errors\n" + path("scene.pbrt")));
}

TEST_F(PbrtOptions, AScenesErrorsAreItsOwn) {
  folder_.write("broken.pbrt", "Film \"rgb\n" + std::string(kOptions) + std::string(kWorld));
  folder_.write("world.inc", kWorld);
  folder_.write("in_two.pbrt", std::string(kOptions) + "Include \"world.inc\"\n");
  const Outcome check =
      frond_command({"check", path("broken.pbrt"), path("none.pbrt"), path("in_two.pbrt"), path("scene.pbrt")});
  EXPECT_EQ(check.code, 1);
  EXPECT_THAT(check.out, AllOf(HasSubstr("broken.pbrt: 1 error\n"), HasSubstr("none.pbrt: 1 error\n"),
                               HasSubstr("in_two.pbrt: no errors"), HasSubstr("scene.pbrt: no errors")));
}

TEST_F(PbrtOptions, CheckCountsWarnings) {
  const std::string empty = std::string(kOptions) + "WorldBegin\n";
  folder_.write("dark.pbrt", empty);
  const Outcome once = frond_command({"check", path("dark.pbrt"), path("scene.pbrt")});
  EXPECT_THAT(once.err, HasSubstr("warning: the scene has no light"));
  EXPECT_THAT(once.out, AllOf(HasSubstr("dark.pbrt: no errors, 1 warning\n"), HasSubstr("scene.pbrt: no errors\n")));
  folder_.write("old.pbrt", "Accelerator \"a\"\nAccelerator \"a\"\n" + empty);
  EXPECT_THAT(frond_command({"check", path("old.pbrt")}).out, HasSubstr("old.pbrt: no errors, 3 warnings\n"));
  EXPECT_THAT(frond_command({"check", "--strict", path("old.pbrt")}).out, HasSubstr("old.pbrt: 3 errors\n"));
}

TEST_F(PbrtOptions, SpectrumFilesMayHaveAnyName) {
  folder_.write("leaf.txt", "360 0.5\n830 0.25\n");
  folder_.write("leaf.pbrt", std::string(kOptions) + std::string(kWorld) +
                                 "Material \"diffuse\" \"spectrum reflectance\" \"leaf.txt\" Shape \"disk\"\n"
                                 "Material \"diffuse\" \"spectrum reflectance\" \"leaf.text\" Shape \"disk\"\n");
  const Outcome check = frond_command({"check", path("leaf.pbrt")});
  EXPECT_THAT(check.err, AllOf(HasSubstr("leaf.pbrt:6:43: "), HasSubstr("leaf.text"), Not(HasSubstr("leaf.txt"))));
}

TEST_F(PbrtOptions, NamesOfOptionsAreThoseOfPbrtInAnySpelling) {
  for (const char* samples : {"-spp", "--SPP", "--s_pp"})
    EXPECT_EQ(
        frond_command({path("scene.pbrt"), samples, "1", "--NThreads=1", "-out_file", path("c.exr"), "--Quiet"}).code,
        0)
        << samples;
  EXPECT_EQ(frond_command({"render", path("scene.pbrt"), "--SPP", "1"}).code, 1);
  const Outcome refused = frond_command({path("scene.pbrt"), "--render-coord-sys", "nonsense"});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, HasSubstr("cameraworld"));
}

TEST_F(PbrtOptions, WhatRenderRefusesCheckRefuses) {
  folder_.write("name.pbrt", "Film \"rgb\" \"string filename\" \"a.xyz\"\n" + std::string(kWorld));
  folder_.write("period.pbrt", "Option \"float period\" [ 1 1 ]\n" + std::string(kOptions) + std::string(kWorld) +
                                   "LightSource \"point\"\n");
  folder_.write("seed.pbrt", "Option \"integer sead\" 1\n" + std::string(kOptions) + std::string(kWorld));
  EXPECT_THAT(frond_command({"check", path("name.pbrt")}).err,
              HasSubstr("name.pbrt:1:6: cannot write \"a.xyz\": images are .exr"));
  EXPECT_THAT(frond_command({"check", path("period.pbrt")}).err, HasSubstr("period.pbrt:6:13: a scene with a"));
  EXPECT_THAT(frond_command({"check", path("seed.pbrt")}).err,
              HasSubstr("seed.pbrt:1:8: there is no option \"sead\"; did you mean \"seed\"?"));
}

TEST_F(PbrtOptions, WarningsOfManyPlacesAreToldOnce) {
  std::string textures, names;
  for (int i = 0; i < 100; ++i) textures += fmt::format("Texture \"t{}\" \"float\" \"ptex\"\n", i);
  for (int i = 0; i < 100; ++i) names += fmt::format("CoordSysTransform \"c{}\"\n", i);
  folder_.write("many.pbrt", std::string(kOptions) + std::string(kWorld) + textures + names);
  const Outcome lenient = frond_command({"check", "--ignore-unsupported", path("many.pbrt")});
  EXPECT_EQ(lenient.code, 0);
  EXPECT_EQ(std::ranges::count(lenient.err, '\n'), 1 + 1 + 20 + 1) << lenient.err;
  EXPECT_THAT(lenient.err, AllOf(HasSubstr("many.pbrt:5:22: warning: Texture \"ptex\" of pbrt-v4"),
                                 HasSubstr("here and at 99 more locations"), HasSubstr("here and 80 more like it")));
}

TEST_F(PbrtOptions, StrictTellsWarningsBesideErrors) {
  folder_.write("both.pbrt", std::string(kOptions) + std::string(kWorld) + "AttributeEnd\nFoo\n");
  for (const char* command : {"check", "render"})
    EXPECT_THAT(frond_command({command, "--strict", path("both.pbrt")}).err,
                AllOf(HasSubstr("both.pbrt:6:1: unknown directive Foo"), HasSubstr("both.pbrt:5:1: AttributeEnd")))
        << command;
}

TEST_F(PbrtOptions, RadiometersAndComparisonsReadScenesAsRenderDoes) {
  for (const char* command : {"brf", "flux"}) {
    std::vector<std::string> words{command, path("other.pbrt"), "--paths", "64"};
    EXPECT_THAT(frond_command(words).err, HasSubstr("with --ignore-unsupported=cameras")) << command;
    words.emplace_back("--ignore-unsupported");
    EXPECT_THAT(frond_command(words).err, Not(HasSubstr("with --ignore-unsupported=cameras"))) << command;
  }
  const Outcome compared =
      frond_command({"compare", path("other.pbrt"), "-o", path("report"), "--ignore-unsupported", "--quick"});
  EXPECT_THAT(compared.err, HasSubstr("none of the materials is a leaf"));
}

TEST(OurScenes, HaveNothingToWarnOf) {
  size_t count = 0;
  for (const auto& folder : std::filesystem::directory_iterator(FROND_SOURCE_DIR "/scenes"))
    if (const auto scene = folder.path() / "scene.pbrt"; std::filesystem::exists(scene)) {
      const Outcome check = frond_command({"check", "--strict", scene.string()});
      EXPECT_EQ(check.code, 0) << check.err;
      ++count;
    }
  EXPECT_GT(count, 0u);
}

TEST_F(PbrtOptions, AllThatIsWrongIsTold) {
  for (const char* command : {"check", "render"}) {
    const Outcome bad = frond_command({command, path("bad.pbrt")});
    EXPECT_EQ(bad.code, 1);
    EXPECT_THAT(bad.err, AllOf(HasSubstr("bad.pbrt:2:9: unknown sampler \"zobol\""),
                               HasSubstr("bad.pbrt:6:16: shape \"sphere\" has no parameter \"radus\""),
                               HasSubstr("bad.pbrt:8:1: Translate takes 3 numbers"),
                               HasSubstr("bad.pbrt:8:42: there is no spectrum texture \"t\"")));
  }
  const Outcome good = frond_command({"check", path("scene.pbrt")});
  EXPECT_EQ(good.code, 0);
  EXPECT_THAT(good.err, IsEmpty());
}

TEST_F(PbrtOptions, WhatIsUnsupportedCanBeLetPass) {
  const Outcome refused = frond_command({"render", path("other.pbrt"), "-o", path("a.exr"), "--spp", "1"});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("other.pbrt:1:33: Camera \"realistic\" of pbrt-v4 is not supported"),
                                 HasSubstr("--ignore-unsupported=textures")));
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--ignore-unsupported", path("other.pbrt")},
                                                {"--ignore-unsupported", "cameras,textures", path("other.pbrt")},
                                                {"--ignore-unsupported=all", path("other.pbrt")}}) {
    const Outcome passed = frond_command({"render", "-o", path("a.exr"), "--spp", "1"}, words);
    EXPECT_EQ(passed.code, 0) << passed.err;
    EXPECT_THAT(passed.err, HasSubstr("warning: Camera \"realistic\" of pbrt-v4 is not supported"));
  }
  EXPECT_EQ(frond_command({"check", "--ignore-unsupported", "cameras", path("other.pbrt")}).code, 1);
}

TEST_F(PbrtOptions, StrictMakesErrorsOfWarnings) {
  folder_.write("warns.pbrt", std::string(kOptions) + std::string(kWorld) + "AttributeEnd\nAttributeEnd\n");
  EXPECT_EQ(frond_command({"check", path("warns.pbrt")}).code, 0);
  const Outcome strict = frond_command({"render", path("warns.pbrt"), "-o", path("a.exr"), "--spp", "1", "--strict"});
  EXPECT_EQ(strict.code, 1);
  EXPECT_THAT(strict.err, AllOf(HasSubstr("warns.pbrt:5:1: AttributeEnd"), HasSubstr("warns.pbrt:6:1: AttributeEnd")));
  EXPECT_FALSE(std::filesystem::exists(path("a.exr")));
  EXPECT_EQ(frond_command({"check", "--strict", path("scene.pbrt")}).code, 0);
}

TEST_F(PbrtOptions, WithoutJitterAllSamplesAreThoseOfThePixelsCentres) {
  const auto variance = [&](const Words& more) {
    const Words words{path("scene.pbrt"), "-o", path("a.exr"), "--spp", "16", "-q", "--integrator", "path,maxdepth=0"};
    EXPECT_EQ(frond_command(words, more).code, 0);
    const Image image = read_image(path("a.exr"), {}).image;
    const size_t green = image.channel("variance.G").value();
    float most = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) most = std::max(most, image.at(x, y, green));
    return most;
  };
  EXPECT_GT(variance({"--disable-wavelength-jitter"}), 1e-4);
  EXPECT_LT(variance({"--disable-pixel-jitter", "--disable-wavelength-jitter"}), 1e-10);  // rounding
}

}  // namespace
}  // namespace frond
