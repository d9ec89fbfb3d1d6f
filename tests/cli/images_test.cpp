#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "image/image_file.h"
#include "tests/support/command_test.h"

/// Messages about images with unused content or values that are not finite.
namespace frond {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Images : public CommandTest {
 protected:
  /// Writes a linear image of 4 x 4 pixels of 0.25, with values set from the first on.
  std::string image(const std::string& name, std::initializer_list<float> values = {}, const std::string& seed = "1") {
    Image pixels(4, 4, {"R", "G", "B"});
    std::ranges::fill(pixels.pixels, 0.25f);
    std::ranges::copy(values, pixels.pixels.begin());
    write_image(path(name), pixels, {.color_space = "linear SMPTE-C", .text = {{"frond:seed", seed}}});
    return path(name);
  }
  nlohmann::json difference(const std::vector<std::string>& halves, std::string& messages) {
    const Outcome o = frond_command({"difference", "--json", path("d.json"), "-o", path("d.png")}, halves);
    EXPECT_EQ(o.code, 0) << o.err;
    messages = o.out + o.err;
    return nlohmann::json::parse(testing_file("d.json"));  // throws for NaN, which is no JSON
  }
  std::string testing_file(const std::string& name) const {
    std::ifstream in(path(name));
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST_F(Images, ConvertNamesWhatIsNotFinite) {
  image("a.exr", {NAN, NAN, NAN, kInfinity, kInfinity, kInfinity});
  const Outcome shown = frond_command({"convert", path("a.exr"), "-o", path("a.png")});
  EXPECT_EQ(shown.code, 0);
  EXPECT_THAT(shown.err, HasSubstr("a.exr holds 3 NaN and 3 infinite values in 2 of 16 pixels: NaN is shown black, "
                                   "infinity white"));
  const Image png = read_image(path("a.png"), {}).image;
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(png.at(0, 0, c), 0);
    EXPECT_EQ(png.at(1, 0, c), 1);
  }
  const Outcome kept = frond_command({"convert", path("a.exr"), "-o", path("b.exr")});
  EXPECT_THAT(kept.err, HasSubstr("2 of 16 pixels: so does the mean"));
  EXPECT_TRUE(std::isnan(read_image(path("b.exr"), {}).image.at(0, 0, 0)));
  image("fine.exr");
  EXPECT_THAT(frond_command({"convert", path("fine.exr"), "-o", path("a.png")}).err, Not(HasSubstr("holds")));
}

TEST_F(Images, SharesOfTheImageAreAtMostAll) {
  Image pixels(4, 4, {"R", "G", "B"});
  for (const float v : {kInfinity, float(NAN), -kInfinity}) {
    std::ranges::fill(pixels.pixels, v);
    write_image(path("a.exr"), pixels, {.color_space = "linear SMPTE-C", .text = {}});
    for (const char* exposure : {"0", "auto"}) {
      const Outcome o = frond_command({"convert", path("a.exr"), "-o", path("a.png"), "--exposure", exposure});
      EXPECT_EQ(o.code, 0);
      EXPECT_THAT(o.err, AllOf(HasSubstr("48 "), HasSubstr("values in 16 of 16 pixels"), Not(HasSubstr("1600 %"))));
    }
  }
}

TEST_F(Images, DifferenceStatesNoErrorOfPixelsThatAreNotFinite) {
  std::string said;
  for (const float v : {float(NAN), kInfinity}) {
    const auto one = difference(
        {image("a1.exr", {v}, "1"), image("a2.exr", {}, "2"), image("b1.exr", {}, "3"), image("b2.exr", {}, "4")},
        said);
    for (const char* fact :
         {"rms_red", "bias_red", "bias_upper_red", "noise_red", "bias_squared_all", "rms_clipped_all"})
      EXPECT_TRUE(one.at(fact).is_null()) << fact << ' ' << one.at(fact);
    EXPECT_THAT(said, AllOf(HasSubstr("a1.exr holds 1 "),
                            HasSubstr("in 1 of 16 pixels: errors over these pixels are "
                                      "not known"),
                            HasSubstr("not known"), Not(HasSubstr("nan"))));
    EXPECT_EQ(read_image(path("d.png"), {}).image.at(0, 0, 0), 0) << "black, where no difference is known";
  }
  const auto both = difference({image("a1.exr", {NAN}, "1"), image("a2.exr", {NAN}, "2"), image("b1.exr", {NAN}, "3"),
                                image("b2.exr", {NAN}, "4")},
                               said);
  EXPECT_TRUE(both.at("bias_all").is_null());
  const auto none = difference(
      {image("a1.exr", {}, "1"), image("a2.exr", {}, "2"), image("b1.exr", {}, "3"), image("b2.exr", {}, "4")}, said);
  EXPECT_EQ(none.at("bias_all"), 0);
  EXPECT_THAT(said, Not(HasSubstr("not known")));
}

/// Three parts, "beauty", "depth" and "diffuse_of_leaves", and one part with the channels R, G, B, A, Z and diffuse.R.
constexpr const char* kFiles[] = {"parts.exr", "layers.exr"};

TEST_F(Images, PartsAndChannelsThatAreNotReadAreNamed) {
  for (const char* file : kFiles)  // into the scene's folder, whose files are quoted
    std::filesystem::copy(fmt::format(FROND_SOURCE_DIR "/tests/public/exr-parts/{}", file), path(file));
  const std::string parts = "only the first of the images in \"" + path("parts.exr") +
                            "\", \"beauty\", is read; 2 are left out: \"depth\", \"diffuse_of_leaves\"";
  EXPECT_THAT(frond_command({"convert", path("parts.exr"), "-o", path("a.png")}).err, HasSubstr(parts));
  const auto check = [this](const std::string& world) {
    folder_.write("s.pbrt", "WorldBegin\n" + world + "\nShape \"sphere\"\n");
    const Outcome o = frond_command({"check", path("s.pbrt")});
    EXPECT_EQ(o.code, 0) << o.err;
    return o.out + o.err;
  };
  const auto texture = [](const std::string& kind, const std::string& file, const std::string& use) {
    return "Texture \"t\" \"" + kind + "\" \"imagemap\" \"string filename\" \"" + file + "\"\n" + use;
  };
  const std::string color = "Material \"diffuse\" \"texture reflectance\" \"t\"";
  const std::string bump = "Material \"diffuse\" \"texture displacement\" \"t\"";
  const std::string layers = "channels of the image that are not used: Z, diffuse.R";
  for (const auto& [file, message] : {std::pair{std::string(kFiles[0]), parts}, {std::string(kFiles[1]), layers}})
    for (const std::string& world : {texture("spectrum", file, color), texture("float", file, bump),
                                     "LightSource \"infinite\" \"string filename\" \"" + file + "\"",
                                     "Material \"diffuse\" \"string normalmap\" \"" + file + "\""}) {
      const std::string said = check(world);
      EXPECT_THAT(said, HasSubstr(message)) << world;
      EXPECT_EQ(said.find(message), said.rfind(message)) << "once";
    }
}

}  // namespace
}  // namespace frond
