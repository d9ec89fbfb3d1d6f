// Scenes in map coordinates: what the commands render, measure and write is as at the origin.

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "image/image_file.h"
#include "tests/support/command_test.h"

namespace frond {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Leaves above a ground, with a camera. Positions are multiples of 1/1024 from (x, y, z).
std::string leaves(double x, double y, double z) {
  std::string text = fmt::format(
      "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 24\n"
      "Sampler \"independent\" \"integer pixelsamples\" 32\n"
      "LookAt {} {} {}  {} {} {}  0 0 1 Camera \"perspective\" \"float fov\" 40\n"
      "Integrator \"path\" \"integer maxdepth\" 6\nWorldBegin\n"
      "LightSource \"infinite\" \"rgb L\" [.3 .3 .3]\n"
      "LightSource \"distant\" \"point3 from\" [1 -1 2] \"point3 to\" [0 0 0] \"rgb L\" [2 2 2]\n"
      "LightSource \"point\" \"point3 from\" [{} {} {}] \"rgb I\" [.5 .5 .5]\n"
      "Material \"diffusetransmission\" \"rgb reflectance\" [.08 .2 .05] \"rgb transmittance\" [.06 .2 .04]\n"
      "ObjectBegin \"leaf\" Shape \"disk\" \"float radius\" .08 ObjectEnd\nTranslate {} {} {}\n"
      "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [.3 .25 .2] Shape \"trianglemesh\" "
      "\"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-2 -2 0 2 -2 0 2 2 0 -2 2 0] AttributeEnd\n",
      x, y - 2, z + 1.5, x, y, z + 0.25, x, y, z + 1, x, y, z);
  for (int i = 0; i < 40; ++i)
    text += fmt::format("AttributeBegin Translate {} {} {} Rotate {} {} 1 0 ObjectInstance \"leaf\" AttributeEnd\n",
                        ((i * 397) % 801 - 400) / 1024., ((i * 211) % 801 - 400) / 1024.,
                        (100 + (i * 97) % 450) / 1024., i * 7 % 60, i % 5 - 2);
  return text;
}

class Coordinates : public CommandTest {
 protected:
  Image rendered(const std::string& name, const std::string& scene, const Words& more = {}) {
    folder_.write(name + ".pbrt", scene);
    const Outcome done = frond_command({"render", path(name + ".pbrt"), "-o", path(name + ".exr")}, more);
    EXPECT_EQ(done.code, 0) << done.err;
    said_ = done.err;
    return read_image(path(name + ".exr"), {}).image;
  }
  std::string said_;
};

TEST_F(Coordinates, ImagesAreTheSameToTheBit) {
  const Image here = rendered("here", leaves(0, 0, 0));
  for (const auto& [x, y, z] : {std::array{1000, 1000, 0},
                                {10000, 0, 0},
                                {100000, 100000, 0},
                                {500000, 5200000, 312},
                                {4500000, 6000000, -100},
                                {0, 10000000, 0}}) {
    const Image there = rendered("there", leaves(x, y, z));
    EXPECT_EQ(here.pixels, there.pixels) << x << ' ' << y << ' ' << z;
    EXPECT_THAT(said_, HasSubstr(fmt::format("relative to ({}, {}, {})", x, y, z)));
  }
}

/// A sum of decimals and an offset has other last bits: the image differs in few pixels, by rays that pass an edge on
/// its other side.
TEST_F(Coordinates, OtherOffsetsChangeNoMoreThanRounding) {
  const Image here = rendered("here", leaves(0, 0, 0));
  const Image there = rendered("there", leaves(500000.123456789, 5200000.987654321, 312.1));
  double square = 0, mean = 0;
  for (size_t i = 0; i < here.pixels.size(); ++i) {
    square += std::pow(double(here.pixels[i] - there.pixels[i]), 2);
    mean += double(here.pixels[i]);
  }
  const auto count = double(here.pixels.size());
  EXPECT_LE(std::sqrt(square / count), 0.01 * mean / count);
}

TEST_F(Coordinates, PositionsAreRelativeToTheOriginOfTheHeader) {
  const Image here = rendered("here", leaves(0, 0, 0), {"--channels", "position"});
  const Image there = rendered("there", leaves(500000, 5200000, 312), {"--channels", "position"});
  EXPECT_EQ(here.pixels, there.pixels);
  EXPECT_EQ(read_image(path("there.exr"), {}).header.text.at("frond:origin"), "500000 5200000 312");
  EXPECT_FALSE(read_image(path("here.exr"), {}).header.text.contains("frond:origin"));
}

TEST_F(Coordinates, RadiometersTakeTargetsInMapCoordinates) {
  const auto measured = [&](const std::string& command, const std::string& scene, const std::string& target) {
    std::string text = scene;
    text.erase(text.find("LightSource \"point\""),
               text.find("Material \"diffusetr") - text.find("LightSource \"point\""));
    folder_.write("s.pbrt", text);
    std::vector<std::string> words{command, path("s.pbrt"), "--wavelengths", "550", "--target", target, "--csv", "-",
                                   "-q"};
    if (command == "flux") words.insert(words.end(), {"--paths", "2000"});
    if (command == "brf") words.insert(words.end(), {"--zenith", "0,40", "--paths", "2000"});
    const Outcome done = frond_command(words);
    EXPECT_EQ(done.code, 0) << done.err;
    return done.out;
  };
  for (const char* command : {"flux", "brf"}) {
    const std::string here = measured(command, leaves(0, 0, 0), "-0.5,0.5,-0.5,0.5,0.75");
    EXPECT_EQ(here, measured(command, leaves(500000, 5200000, 312), "499999.5,500000.5,5199999.5,5200000.5,312.75"))
        << command;
    const Outcome beside = frond_command({command, path("s.pbrt"), "--wavelengths", "550", "--target", "0,1,0,1,0"});
    EXPECT_THAT(beside.err, HasSubstr("the scene, which reaches from (499998, 5199998) to (500002, 5200002)"));
  }
}

TEST_F(Coordinates, InstanceTablesOfSurveyedPlants) {
  const auto table = [&](const std::string& csv) {
    folder_.write("leaves.csv", csv);
    const Outcome done = frond_command({"instances", path("leaves.csv"), "-o", path("leaves.npy")});
    EXPECT_EQ(done.code, 0) << done.err;
    said_ = done.err;
    std::ifstream stream(path("leaves.npy"), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  EXPECT_THAT(table("x,y,z\n1,2,3\n"), HasSubstr("<f4"));
  EXPECT_THAT(said_, Not(HasSubstr("64-bit")));
  const std::string bytes = table("x,y,z,scale,zenith,azimuth\n500000.13,4000000.37,1.25,0.05,0,0\n");
  EXPECT_THAT(said_, HasSubstr("64-bit floats for positions far from the origin"));
  EXPECT_THAT(bytes, HasSubstr("'<f8'"));
  double y = 0;
  std::memcpy(&y, bytes.data() + bytes.size() - 5 * sizeof y, sizeof y);
  EXPECT_EQ(y, 4000000.37);
}

}  // namespace
}  // namespace frond
