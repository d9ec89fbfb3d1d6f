#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>

#include "image/image_file.h"
#include "tests/support/command_test.h"
#include "tests/support/tev_listener.h"

namespace frond {
namespace {

using test::TevListener;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;
using Manner = TevListener::Manner;

class LiveDisplay : public CommandTest {
 protected:
  void SetUp() override { write_scene("scene.pbrt", 50, 40); }
  void write_scene(const std::string& name, int width, int height) const {
    folder_.write(name, fmt::format(R"(
LookAt 0 0 2  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" {} "integer yresolution" {} "integer pixelbounds" [ 2 {} 1 {} ]
Sampler "lattice" "integer pixelsamples" 16
Integrator "path" "integer maxdepth" 2
WorldBegin
LightSource "infinite" "rgb L" [.3 .4 .5]
Material "diffuse" "rgb reflectance" [.2 .5 .1]
Shape "sphere" "float radius" .5
)",
                                    width, height, width, height));
  }
  Outcome render(const std::string& output, const Words& more) const {
    return frond_command({"render", path("scene.pbrt"), "--no-cache", "-o", path(output)}, more);
  }
};

TEST_F(LiveDisplay, ExposureIsForDisplaysAndInTheHeader) {
  ASSERT_EQ(render("plain.png", {"--seed", "3"}).code, 0);
  const Outcome up = render("up.png", {"--seed", "3", "--exposure", "1"});
  ASSERT_EQ(up.code, 0) << up.err;
  const Outcome metered = render("auto.png", {"--seed", "3", "--exposure", "auto"});
  EXPECT_THAT(metered.err, HasSubstr("auto.png: exposure -"));  // the sky is brighter than mid grey
  const auto header = [this](const char* name) { return read_image(path(name), {}).header.text; };
  EXPECT_EQ(header("up.png").at("frond:exposure"), "1");
  EXPECT_THAT(header("up.png").at("frond:command"), HasSubstr(" --exposure=1"));
  EXPECT_FALSE(header("plain.png").contains("frond:exposure"));
  const auto green = [this](const char* name) { return read_image(path(name), {}).image.at(24, 20, 1); };
  EXPECT_LT(green("auto.png"), green("plain.png"));
  EXPECT_LT(green("plain.png"), green("up.png"));
  // The exposure of the header repeats the image.
  const std::string stops = header("auto.png").at("frond:exposure");
  ASSERT_EQ(render("again.png", {"--seed", "3", "--exposure=" + stops}).code, 0);
  EXPECT_EQ(read_image(path("again.png"), {}).image.pixels, read_image(path("auto.png"), {}).image.pixels);

  EXPECT_THAT(render("x.exr", {"--exposure", "auto"}).err, HasSubstr("--exposure is for .png and .jpg"));
  EXPECT_THAT(render("x.png", {"--exposure", "bright"}).err, HasSubstr("(stops) or auto is needed"));
  EXPECT_THAT(frond_command({"render", path("scene.pbrt"), "--part", path("a.part"), "--exposure", "1"}).err,
              HasSubstr("--exposure is for an image: frond merge"));
  ASSERT_EQ(frond_command({"render", path("scene.pbrt"), "--part", path("a.part"), "--seed", "3", "-q"}).code, 0);
  ASSERT_EQ(frond_command({"merge", path("a.part"), "-o", path("merged.png"), "--exposure", "auto"}).code, 0);
  EXPECT_EQ(read_image(path("merged.png"), {}).image.pixels, read_image(path("auto.png"), {}).image.pixels);
}

TEST_F(LiveDisplay, AnExposureIsSuggestedForABlackImageAndConvertHasIt) {
  const Outcome dark = render("dark.png", {"--swap", "diffuse=diffuse,reflectance=0", "--pixels", "24,26,19,21"});
  EXPECT_EQ(dark.code, 0) << dark.err;  // black, not dark: no exposure helps
  EXPECT_THAT(dark.err, Not(HasSubstr("--exposure")));
  ASSERT_EQ(render("a.exr", {}).code, 0);
  const auto converted = [this](const Words& more) {
    const Outcome o = frond_command({"convert", path("a.exr"), "-o", path("c.png")}, more);
    EXPECT_EQ(o.code, 0) << o.err;
    return o.err;
  };
  EXPECT_THAT(converted({"--exposure=-9"}),
              HasSubstr("nearly all of the image is too dark to be seen: --exposure auto"));
  EXPECT_THAT(converted({"--exposure", "9"}), HasSubstr("of the image is brighter than white"));
  EXPECT_THAT(converted({"--exposure", "auto"}), HasSubstr("c.png: exposure -"));
  EXPECT_THAT(converted({}), IsEmpty());
}

/// In the light of a lamp a grey surface is grey, by the lights of the scene, by their temperature, and in a
/// conversion.
TEST_F(LiveDisplay, WhiteBalanceMakesTheScenesLightWhite) {
  folder_.write(
      "scene.pbrt",
      "Camera \"orthographic\"\nFilm \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n"
      "LightSource \"infinite\" \"spectrum L\" \"stdillum-A\"\nMaterial \"diffuse\"\nTranslate 0 0 1\n"
      "Shape \"disk\" \"float radius\" 9\n");
  const auto color = [this](const char* name) {
    const Image image = read_image(path(name), {}).image;
    return std::pair(image.at(4, 4, 0) / image.at(4, 4, 1), image.at(4, 4, 2) / image.at(4, 4, 1));
  };
  const std::vector<std::string> many{"--spp", "256"};
  ASSERT_EQ(render("lamp.png", many).code, 0);
  EXPECT_GT(color("lamp.png").first, 1.3);
  for (const char* white : {"auto", "2856"}) {
    const Outcome o = render("white.png", {many[0], many[1], "--white-balance", white});
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NEAR(color("white.png").first, 1, 0.02) << white;
    EXPECT_NEAR(color("white.png").second, 1, 0.02) << white;
    const auto text = read_image(path("white.png"), {}).header.text;
    EXPECT_THAT(text.at("frond:white_balance"), StartsWith("0.44"));
    EXPECT_THAT(text.at("frond:command"), HasSubstr(std::string(" --white-balance ") + white));
  }
  ASSERT_EQ(render("a.exr", many).code, 0);
  EXPECT_EQ(read_image(path("a.exr"), {}).header.text.at("frond:light_white").substr(0, 4), "0.44");
  EXPECT_EQ(frond_command({"convert", path("a.exr"), "-o", path("c.png"), "--white-balance", "auto"}).code, 0);
  EXPECT_NEAR(color("c.png").first, 1, 0.02);
  EXPECT_EQ(frond_command({"convert", path("a.exr"), "-o", path("b.exr")}).code, 0);
  EXPECT_THAT(frond_command({"convert", path("b.exr"), "-o", path("c.png"), "--white-balance", "auto"}).err,
              HasSubstr("does not state the light of its scene"));
  EXPECT_THAT(render("x.exr", {"--white-balance", "auto"}).err, HasSubstr("--white-balance is for .png and .jpg"));
  EXPECT_THAT(render("x.png", {"--white-balance", "warm"}).err, HasSubstr("(K) or auto is needed"));
}

TEST_F(LiveDisplay, ShowsWhatTheFileHoldsInTheEnd) {
  for (const Words& more : {Words{},
                            {"--filter", "box"},
                            {"--wavelengths", "bands,wavelengths=430,500,560,610,680,780"},
                            {"--wavelengths", "bands,wavelengths=600,650"},
                            {"--max-rms", "0.05", "--spp", "64"},
                            {"--channels", "normal", "--checkpoint", "100"}}) {
    TevListener listener;
    const Outcome o = render("a.exr", joined({"--display-server", listener.address()}, more));
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_THAT(o.err, Not(HasSubstr("display:")));
    listener.join();
    std::filesystem::remove(path("a.exr.part"));
    const Image file = read_image(path("a.exr"), {}).image;
    EXPECT_THAT(listener.faults(), IsEmpty());
    ASSERT_THAT(listener.images(), SizeIs(1));
    const auto& [name, shown] = *listener.images().begin();
    EXPECT_THAT(name, StartsWith("a.exr ("));
    EXPECT_EQ(shown.width, 48);
    EXPECT_EQ(shown.height, 39);
    ASSERT_EQ(shown.width, file.width);
    ASSERT_EQ(shown.height, file.height);
    ASSERT_THAT(shown.channels, Not(IsEmpty()));
    for (const std::string& channel : shown.channels) {
      ASSERT_TRUE(file.channel(channel)) << channel;
      EXPECT_EQ(shown.values.at(channel), file.plane(*file.channel(channel))) << channel;
    }
    EXPECT_THAT(shown.updates, ::testing::Each(::testing::Ge(1)));
  }
}

TEST_F(LiveDisplay, ShowsPartsAndImagesOfEightBitsToo) {
  for (const char* output : {"a.png", "a.part"}) {
    TevListener listener;
    const Outcome o =
        frond_command({"render", path("scene.pbrt"), "--no-cache", "-q", "--display-server", listener.address(),
                       std::string(output) == "a.part" ? "--part" : "-o", path(output)});
    EXPECT_EQ(o.code, 0) << o.err;
    listener.join();
    EXPECT_THAT(listener.faults(), IsEmpty());
    ASSERT_THAT(listener.images(), SizeIs(1));
    const TevListener::Shown& shown = listener.images().begin()->second;
    EXPECT_EQ(shown.channels, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_GT(shown.values.at("G")[0], 0);
  }
}

TEST_F(LiveDisplay, ThatIsNotThereIsAWarning) {
  const test::Port port;
  const Outcome o = render("a.exr", {"--display-server", port.address(), "--strict"});
  EXPECT_EQ(o.code, 0);
  EXPECT_THAT(o.err, HasSubstr("warning: display: cannot connect to " + port.address() + ": Connection refused; "));
  EXPECT_TRUE(std::filesystem::exists(path("a.exr")));
}

TEST_F(LiveDisplay, ThatGoesAwayIsAWarning) {
  TevListener listener(Manner::closes_early);
  write_scene("scene.pbrt", 400, 300);
  const Outcome o = render("a.exr", {"--display-server", listener.address()});
  EXPECT_EQ(o.code, 0);
  EXPECT_THAT(o.err, AllOf(HasSubstr("display: " + listener.address()), HasSubstr("has closed the connection")));
  EXPECT_TRUE(std::filesystem::exists(path("a.exr")));
}

TEST_F(LiveDisplay, ThatDoesNotReadIsAWarningAndTheFileIsWritten) {
  TevListener listener(Manner::never_reads);
  write_scene("scene.pbrt", 900, 600);  // more than the system keeps for one who does not read
  const Outcome o = render("a.exr", {"--spp", "1", "--display-server", listener.address()});
  EXPECT_EQ(o.code, 0);
  EXPECT_THAT(o.err, AllOf(HasSubstr("display: " + listener.address()), HasSubstr("no more data")));
  EXPECT_TRUE(std::filesystem::exists(path("a.exr")));
}

TEST_F(LiveDisplay, HasAnAddress) {
  for (const char* address : {"", "localhost", "localhost:0", ":14158", "localhost:nonsense"}) {
    const Outcome o = render("a.exr", {"--display-server", address});
    EXPECT_EQ(o.code, 1) << address;
    EXPECT_THAT(o.err, HasSubstr("--display-server takes HOST:PORT")) << address;
  }
  EXPECT_FALSE(std::filesystem::exists(path("a.exr")));
}

// Whether a viewer is at home there or not.
TEST_F(LiveDisplay, TevIsNoDisplayOfImages) {
  const Outcome o = render("a.exr", {"--display", "tev", "--spp", "1"});
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, ::testing::AnyOf(Not(HasSubstr("display:")), HasSubstr("127.0.0.1:14158")));
  EXPECT_THAT(render("b.exr", {"--display", "sRGB"}).err, HasSubstr("holds linear values"));
}

TEST_F(LiveDisplay, NeedsATerminalForAPreview) {
  const Outcome o = render("a.exr", {"--preview"});
  EXPECT_EQ(o.code, 1);
  EXPECT_EQ(o.err, "frond: --preview: neither standard error nor standard output is a terminal to draw on\n");
}

}  // namespace
}  // namespace frond
