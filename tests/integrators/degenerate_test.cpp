#include <gtest/gtest.h>

#include <cmath>

#include "image/image_file.h"
#include "tests/support/input_error.h"
#include "tests/support/render_text.h"

namespace frond {
namespace {

using test::channel_mean;
using test::render_text;

const std::string kOptions = R"(
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Sampler "independent"
)";
const std::string kLights = R"(
LightSource "infinite" "spectrum L" "stdillum-D65"
LightSource "distant" "point3 from" [0 -1 2] "point3 to" [0 0 0] "spectrum L" "stdillum-D65"
)";

/// Seen from (0, -3, 2) times `scale`.
std::string scene(const std::string& world, const std::string& scale = "") {
  return fmt::format("LookAt 0 -3{0} 2{0}  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 40\n{1}WorldBegin\n{2}",
                     scale, kOptions, world);
}

std::string plane(const std::string& more, const std::string& scale = "") {
  return fmt::format(
      "Shape \"trianglemesh\" \"point3 P\" [-9{0} -9{0} 0  9{0} -9{0} 0  9{0} 9{0} 0  -9{0} 9{0} 0] "
      "\"integer indices\" [0 1 2  0 2 3] {1}\n",
      scale, more);
}

/// Mean of the image, all of whose samples are finite.
double mean_of(const std::string& text) {
  const Film film = render_text(text);
  EXPECT_EQ(film.not_finite(), 0) << text;
  return channel_mean(film, 1).mean;
}

TEST(Degenerate, NormalsOfAnyLengthShadeAlike) {
  for (const char* material : {"Material \"diffuse\"\n", "Material \"abm\"\n"}) {
    const double expected = mean_of(scene(kLights + material + plane(R"("normal N" [0 0 1 0 0 1 0 0 1 0 0 1])")));
    EXPECT_GT(expected, 0.1);
    for (const char* n : {"[0 0 0 0 0 0 0 0 0 0 0 0]", "[0 0 1e-30 0 0 1e-30 0 0 1e-30 0 0 1e-30]",
                          "[0 0 1e30 0 0 1e30 0 0 1e30 0 0 1e30]"})
      // The same paths up to rounding; a walk that rounds otherwise takes another way.
      EXPECT_NEAR(mean_of(scene(kLights + material + plane(fmt::format("\"normal N\" {}", n)))), expected,
                  0.1 * expected)
          << material << n;
  }
}

TEST(Degenerate, ScenesOfAnySizeLookAlike) {
  const std::string material = "Material \"diffuse\"\n";
  const double expected = mean_of(scene(kLights + material + plane("")));
  for (const char* scale : {"e-14", "e-8", "e8", "e11"})
    EXPECT_NEAR(mean_of(scene(kLights + material + plane("", scale), scale)), expected, 1e-3 * expected) << scale;
  for (const char* scale : {"e-8", "e8"}) {
    const std::string inverse = scale[1] == '-' ? "1e8" : "1e-8";
    const std::string instance = fmt::format("ObjectBegin \"o\"\n{0}ObjectEnd\nScale {1} {1} {1} ObjectInstance \"o\"",
                                             plane("", scale), inverse);
    EXPECT_NEAR(mean_of(scene(kLights + material + instance)), expected, 1e-3 * expected) << scale;
  }
}

TEST(Degenerate, PatchesAndTrianglesWithoutAreaDoNoHarm) {
  mean_of(scene(kLights + R"(Material "abm"
Shape "trianglemesh" "point3 P" [0 0 0 0 0 0 0 0 0]
Shape "trianglemesh" "point3 P" [-1 0 0 0 0 0 1 0 0]
Shape "bilinearmesh" "point3 P" [0 0 0 0 0 0 0 0 0 0 0 0]
Shape "bilinearmesh" "point3 P" [-1 0 0 1 0 0 -1 0 0 1 0 0]
)"));
}

TEST(Degenerate, LightsOfAnySizeAndPlace) {
  for (
      const char* light :
      {R"(LightSource "point" "point3 from" [0 0 0])", R"(LightSource "spot" "point3 from" [0 0 0])",
       R"(LightSource "point" "point3 from" [0 0 1e-20])",
       R"(LightSource "distant" "point3 from" [1 0 0] "point3 to" [0 0 0])",
       R"(AreaLightSource "diffuse" "bool twosided" true Shape "trianglemesh" "point3 P" [0 0 1 1e-10 0 1 0 1e-10 1])",
       R"(AreaLightSource "diffuse" "bool twosided" true Shape "bilinearmesh" "point3 P" [-1e17 -1e17 10  1e17 -1e17 10  -1e17 1e17 10  1e17 1e17 10])"})
    mean_of(scene("Material \"diffuse\"\n" + plane("") + light));
}

TEST(Degenerate, CamerasInAndOnSurfaces) {
  for (const char* view : {"LookAt 0 0 0  0 1 0  0 0 1", "LookAt 0 -1 0  0 0 0  0 0 1", "LookAt 0 -3 0  0 0 0  0 0 1"})
    for (const char* material : {"diffuse", "abm", "diffusetransmission"})
      mean_of(fmt::format("{}\nCamera \"perspective\"\n{}WorldBegin\n{}Material \"{}\" Shape \"sphere\"\n{}", view,
                          kOptions, kLights, material, plane("")));
}

/// Every scattered path is specular, although the material's density is approximate elsewhere: no fault, and a mirror's
/// image of an even light.
TEST(Degenerate, SmoothCoatsOverSmoothMetal) {
  for (const std::string eta : {"1.5", "0.6"}) {
    RenderStatistics statistics;
    const std::string coated =
        "Material \"coatedconductor\" \"float interface.roughness\" 0 \"float conductor.roughness\" 0 "
        "\"float interface.eta\" " +
        eta + " \"rgb reflectance\" [.9 .9 .9]";
    const Film film = render_text(scene("LightSource \"infinite\" \"rgb L\" [1 1 1]\n" + coated + " Shape \"sphere\""),
                                  {.statistics = &statistics});
    EXPECT_TRUE(statistics.faults.empty()) << eta;
    EXPECT_EQ(film.not_finite(), 0u) << eta;
    EXPECT_GT(test::channel_mean(film, 1).mean, 0.5) << eta;
  }
}

TEST(Degenerate, SamplesThatAreNoNumbersAreCounted) {
  const Film film =
      render_text(kOptions + "WorldBegin LightSource \"infinite\" \"rgb L\" [3e38 3e38 3e38] \"float scale\" 1e38");
  EXPECT_EQ(film.not_finite(), 8 * 8 * 16);
  EXPECT_EQ(channel_mean(film, 1).mean, 0);
}

void expect_error(const std::string& text, const std::string& message) {
  const std::string error = error_of([&] { render_text(text); });
  EXPECT_NE(error.find(message), std::string::npos) << error << "\n" << text;
}

TEST(Degenerate, WhatEmbreeWouldLeaveOutIsRefused) {
  expect_error("WorldBegin Scale 10 10 10\nShape \"trianglemesh\" \"point3 P\" [0 0 1e38 1e38 0 0 0 1e38 0]",
               "test.pbrt:2:7: this shape reaches to");
  expect_error("WorldBegin\nShape \"sphere\" \"float radius\" 1e20", "test.pbrt:2:7: this shape reaches to");
  for (const std::string type : {"point", "spot"})
    expect_error("WorldBegin Translate 0 0 2e18\nLightSource \"" + type + "\"",
                 "test.pbrt:2:13: this light reaches to (0, 0, 2e+18)");
  expect_error("LookAt 0 -3e18 2 0 0 0 0 0 1\nCamera \"perspective\"\nWorldBegin",
               "test.pbrt:2:8: a ray of this camera");
  expect_error("WorldBegin ObjectBegin \"o\" ObjectEnd Scale 1e-12 1 1\nObjectInstance \"o\"",
               "test.pbrt:2:16: this instance is not possible: it scales by 1e-12");
  expect_error("Camera \"perspective\" \"float lensradius\" 1e30\nWorldBegin", "test.pbrt:1:8: a ray of this camera");
}

TEST(Degenerate, PointsAreAsFarApartAsEmbreeAllows) {
  const Film film = render_text(
      "LookAt 0 0 3  0 0 0  0 1 0 Camera \"perspective\" " + kOptions +
      "WorldBegin LightSource \"point\" \"point3 from\" [5e17 5e17 5e17] Shape \"disk\" Translate -5e17 -5e17 -5e17 "
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 5e17 0 5e17 0 5e17 5e17]");
  EXPECT_EQ(film.not_finite(), 0u);
}

TEST(Degenerate, RaysInTheSpaceOfSmallInstancesAreAsLongAsEmbreeAllows) {
  const auto text = [](const std::string& distance) {
    return "LookAt 0 0 " + distance + "  0 0 0  0 1 0\nCamera \"orthographic\" " + kOptions +
           "WorldBegin LightSource \"infinite\" ObjectBegin \"o\" Shape \"sphere\" \"float radius\" 1e8 ObjectEnd\n"
           "Scale 1e-8 1e-8 1e-8 ObjectInstance \"o\"";
  };
  EXPECT_GT(channel_mean(render_text(text("1e9")), 1).mean, 0.1);
  expect_error(text("1e11"), "test.pbrt:2:8: the scene with its camera and lights reaches to 1e+11 units");
}

TEST(Degenerate, WhatNothingUsesIsCheckedToo) {
  expect_error("WorldBegin\nMaterial \"diffuse\" \"rgb reflectanc\" [1 1 1]", "did you mean \"reflectance\"?");
  expect_error("WorldBegin\nMakeNamedMaterial \"m\" \"string type\" \"difuse\"", "did you mean \"diffuse\"?");
  expect_error("WorldBegin\nTexture \"t\" \"float\" \"constant\" \"float valu\" 1", "did you mean \"value\"?");
  expect_error("WorldBegin\nAreaLightSource \"difuse\"", "area light \"difuse\"");
}

TEST(Degenerate, DeepNestsAreRefused) {
  std::string textures = "Texture \"t0\" \"float\" \"constant\"\n",
              materials = "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n";
  for (int i = 1; i <= 3000; ++i) {
    textures += fmt::format("Texture \"t{}\" \"float\" \"scale\" \"texture tex\" \"t{}\"\n", i, i - 1);
    materials += fmt::format(
        "MakeNamedMaterial \"m{0}\" \"string type\" \"mix\" \"string materials\" [\"m{1}\" \"m{1}\"]\n", i, i - 1);
  }
  expect_error("WorldBegin\n" + textures + "Shape \"disk\" \"texture alpha\" \"t3000\"", "nested more than 16 deep");
  expect_error("WorldBegin\n" + materials + "NamedMaterial \"m3000\" Shape \"disk\"", "nested more than 16 deep");
}

TEST(Degenerate, NarrowSpotsAreRefused) {
  expect_error("WorldBegin\nLightSource \"spot\" \"float coneangle\" .002 \"float conedeltaangle\" 0",
               "lets no light through");
}

TEST(Degenerate, ImagesWithNaNAreRefusedEverywhere) {
  const TestFolder folder("nan");
  Image image(4, 4, {"R", "G", "B"});
  image.pixels.assign(image.pixels.size(), 0.5f);
  image.at(2, 1, 1) = NAN;
  const std::string name = folder.name_of("nan.exr");
  write_image(name, image, {"linear sRGB", {}});
  const std::string file = fmt::format("\"string filename\" \"{}\"", name),
                    place = "holds the value nan in column 2, row 1";
  expect_error("WorldBegin\nLightSource \"infinite\" " + file, place);
  expect_error("WorldBegin\nTexture \"t\" \"float\" \"imagemap\" " + file + "\nShape \"disk\" \"texture alpha\" \"t\"",
               place);
  expect_error("WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\" " + file +
                   "\nMaterial \"diffuse\" \"texture reflectance\" \"t\" Shape \"disk\"",
               place);
}

}  // namespace
}  // namespace frond
