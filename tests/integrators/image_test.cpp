#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "image/image_file.h"
#include "tests/support/input_error.h"
#include "tests/support/render_text.h"

namespace frond {
namespace {

using test::channel_mean;
using test::render_text;

/// A plane seen from above so that its (u, v) spans the image: u to the right, v up.
std::string textured_plane(const std::string& texture, const std::string& material) {
  return fmt::format(R"(
Scale -1 1 1
LookAt 0 0 1  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-.5 .5 -.5 .5]
Film "rgb" "integer xresolution" 2 "integer yresolution" 2
Sampler "independent"
PixelFilter "box" "float xradius" .01 "float yradius" .01
Integrator "path" "integer maxdepth" 1
WorldBegin
LightSource "distant" "point3 from" [0 0 1] "point3 to" [0 0 0] "spectrum L" "stdillum-D65" "float illuminance" 3.14159265
{}
{}
Shape "trianglemesh" "point3 P" [-.5 -.5 0  .5 -.5 0  .5 .5 0  -.5 .5 0] "point2 uv" [0 0  1 0  1 1  0 1] "integer indices" [0 1 2  0 2 3]
)",
                     texture, material);
}

Image two_by_two(const std::array<float, 4>& grey) {
  Image image(2, 2, {"R", "G", "B"});
  for (size_t i = 0; i < 4; ++i)
    for (size_t c = 0; c < 3; ++c) image.at(int(i % 2), int(i / 2), c) = grey[i];
  return image;
}

const std::string kTexturedDiffuse = R"(Material "diffuse" "texture reflectance" "t")";

TEST(ImageTexture, FirstRowIsAtTheTopAndColoursComeThrough) {
  const TestFolder folder("imagemap");
  const std::array<float, 4> grey{0.1f, 0.3f, 0.5f, 0.8f};
  write_image(folder.name_of("t.exr"), two_by_two(grey), {"linear sRGB", {}});
  const std::string texture =
      fmt::format("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"{}\" \"string filter\" \"point\"",
                  folder.name_of("t.exr"));
  const Film film = render_text(textured_plane(texture, kTexturedDiffuse), {.samples = 4});
  // Albedo shows as it is: the illuminance is pi. RGB to spectrum and back costs up to 1e-3 at single wavelengths.
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(film.mean(int(i % 2), int(i / 2))[1], double(grey[i]), 2e-3) << i;
}

TEST(ImageTexture, BilinearMeetsInTheMiddleAndWrapsAround) {
  const TestFolder folder("imagemap");
  write_image(folder.name_of("t.exr"), two_by_two({0.2f, 0.6f, 0.2f, 0.6f}), {"linear sRGB", {}});
  // Half a texel to the side, every pixel's centre lies between two texels.
  const std::string texture =
      fmt::format("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"{}\" \"float udelta\" .25",
                  folder.name_of("t.exr"));
  const Film film = render_text(textured_plane(texture, kTexturedDiffuse), {.samples = 64});
  for (int x = 0; x < 2; ++x) EXPECT_NEAR(film.mean(x, 0)[1], 0.4, 5e-3);
}

TEST(ImageTexture, EightBitImagesAreDecoded) {
  const TestFolder folder("imagemap");
  write_image(folder.name_of("t.png"), two_by_two({0.5f, 0.5f, 0.5f, 0.5f}), {});
  const std::string texture =
      fmt::format("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"{}\"", folder.name_of("t.png"));
  const Film film = render_text(textured_plane(texture, kTexturedDiffuse), {.samples = 1});
  // 128 / 255 in sRGB (IEC 61966-2-1).
  EXPECT_NEAR(film.mean(0, 0)[1], std::pow((128.0 / 255 + 0.055) / 1.055, 2.4), 2e-3);
}

TEST(ImageTexture, AlphaFromAnImageCutsHoles) {
  const TestFolder folder("alpha");
  write_image(folder.name_of("t.exr"), two_by_two({0, 1, 1, 0}), {"linear sRGB", {}});
  const std::string scene = textured_plane(
      fmt::format("Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"{}\" \"string filter\" \"point\"",
                  folder.name_of("t.exr")),
      "Attribute \"shape\" \"texture alpha\" \"t\"\nMaterial \"diffuse\"");
  const Film film = render_text(scene, {.samples = 4});
  EXPECT_EQ(film.mean(0, 0)[1], 0);
  EXPECT_EQ(film.mean(1, 1)[1], 0);
  EXPECT_NEAR(film.mean(1, 0)[1], 0.5, 1e-5);
}

TEST(ImageTexture, WhatIsNoReflectanceIsClamped) {
  const TestFolder folder("imagemap");
  write_image(folder.name_of("t.exr"), two_by_two({0.2f, 2, 0, 1}), {"linear sRGB", {}});
  const std::string texture =
      fmt::format("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"{}\" \"string filter\" \"point\"",
                  folder.name_of("t.exr"));
  const Film film = render_text(textured_plane(texture, kTexturedDiffuse), {.samples = 4});
  EXPECT_NEAR(film.mean(1, 0)[1], 1, 2e-3);
}

// The bounds of noise contain values that it never has: they do not show that values are given in another unit.
TEST(NoiseTexture, MayExceedTheRangeOfAParameterWithAUnit) {
  EXPECT_NO_THROW(render_text(textured_plane(R"(Texture "noise" "float" "fbm"
Texture "t" "float" "mix" "texture amount" "noise" "float tex1" 10 "float tex2" 55)",
                                             R"(Texture "earth" "spectrum" "soil" "texture moisture" "t"
Material "diffuse" "texture reflectance" "earth")"),
                              {.samples = 1}));
}

TEST(Reflectances, AboveOneAreOne) {
  const auto green = [](const std::string& reflectance) {
    const std::string material = "Material \"diffuse\" " + reflectance;
    return render_text(textured_plane("", material), {.samples = 1}).mean(0, 0)[1];
  };
  const double white = green("\"spectrum reflectance\" [360 1 2500 1]");
  EXPECT_EQ(green("\"spectrum reflectance\" [360 18 2500 18]"), white);
  EXPECT_LT(green("\"blackbody reflectance\" 5000"), white);
  EXPECT_GT(green("\"blackbody reflectance\" 5000"), 0.99 * white);
}

TEST(Cameras, DoNotSeeThePlaneThatTheyLieIn) {
  const Film film = render_text(R"(
Film "rgb" "integer xresolution" 2 "integer yresolution" 2
PixelFilter "box"
Integrator "path" "integer maxdepth" 1
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
Material "diffuse" "spectrum reflectance" [360 0 2500 0]
Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]
Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 0  1 1 0]
Shape "disk")",
                                {.samples = 4});
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(film.mean(i % 2, i / 2)[1], 1, 1e-3) << i;
}

TEST(NormalMap, TurnsLightAway) {
  const TestFolder folder("normalmap");
  // 45 degrees towards u everywhere: 2 c - 1 = (1, 0, 1) / sqrt 2.
  Image image(1, 1, {"R", "G", "B"});
  const float half = 0.5f + 0.5f / std::sqrt(2.f);
  image.at(0, 0, 0) = half, image.at(0, 0, 1) = 0.5f, image.at(0, 0, 2) = half;
  write_image(folder.name_of("n.exr"), image, {"linear sRGB", {}});
  const std::string diffuse = "Material \"diffuse\" \"spectrum reflectance\" [360 .5 2500 .5] ";
  const Film film =
      render_text(textured_plane("", fmt::format("{}\"string normalmap\" \"{}\"", diffuse, folder.name_of("n.exr"))),
                  {.samples = 4});
  EXPECT_NEAR(film.mean(0, 0)[1], 0.5 / std::numbers::sqrt2, 1e-3);
}

TEST(BumpMap, SlopesAsItsTexture) {
  // Height u on a plane whose (u, v) span a unit: 45 degrees.
  const std::string slope =
      "Texture \"h\" \"float\" \"bilerp\" \"float v00\" 0 \"float v10\" 1 \"float v01\" 0 \"float v11\" 1";
  const std::string diffuse = "\"diffuse\" \"spectrum reflectance\" [360 .5 2500 .5] \"texture displacement\" \"h\"";
  const Film film = render_text(textured_plane(slope, "Material " + diffuse), {.samples = 4});
  EXPECT_NEAR(film.mean(0, 0)[1], 0.5 / std::numbers::sqrt2, 2e-3);
  // Also as part of a mixture, whose other part is flat.
  const std::string mixture =
      "MakeNamedMaterial \"bent\" \"string type\" " + diffuse +
      " MakeNamedMaterial \"flat\" \"string type\" \"diffuse\" \"spectrum reflectance\" [360 .5 2500 .5]"
      " Material \"mix\" \"string materials\" [\"bent\" \"flat\"] \"float amount\" .5";
  const Film mixed = render_text(textured_plane(slope, mixture), {.samples = 4});
  EXPECT_NEAR(mixed.mean(0, 0)[1], 0.25 / std::numbers::sqrt2 + 0.25, 2e-3);
}

/// A plane under an environment image, for both kinds of sampling.
Film under_environment(const std::string& file, const char* direct) {
  return render_text(fmt::format(R"(
LookAt 0 0 1  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-.01 .01 -.01 .01]
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
Sampler "independent"
PixelFilter "box"
Integrator "path" "integer maxdepth" 1 "bool sampledirect" {}
WorldBegin
AttributeBegin
Rotate 37 0 0 1
LightSource "infinite" "string filename" "{}"
AttributeEnd
Material "diffuse" "spectrum reflectance" [360 .5 2500 .5]
Shape "trianglemesh" "point3 P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0] "integer indices" [0 1 2  0 2 3]
)",
                                 direct, file),
                     {.samples = 400});
}

TEST(ImageEnvironment, OfOneValueIsLikeTheConstantLight) {
  const TestFolder folder("environment");
  write_image(folder.name_of("e.exr"), two_by_two({1, 1, 1, 1}), {"linear sRGB", {}});
  for (const char* direct : {"true", "false"}) {
    const auto [mean, error] = channel_mean(under_environment(folder.name_of("e.exr"), direct), 1);
    // White comes back within the error of its spectrum.
    EXPECT_NEAR(mean, 0.5, 5 * error + 1e-3) << direct;
    EXPECT_LT(error, 2e-3);
  }
}

TEST(ImageEnvironment, LightComesFromWhereTheImageHasIt) {
  const TestFolder folder("environment");
  // In the equal-area map the square's centre is +z and its corners are -z: the middle texels look up.
  Image image(8, 8, {"R", "G", "B"});
  for (int y = 3; y < 5; ++y)
    for (int x = 3; x < 5; ++x)
      for (size_t c = 0; c < 3; ++c) image.at(x, y, c) = 2;
  write_image(folder.name_of("e.exr"), image, {"linear sRGB", {}});
  // Four texels of 64 around the pole: an octagon-like cap of 4 pi / 16; its irradiance by the projected solid angle,
  // summed over the map, whose area is even in solid angle.
  double cosines = 0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      // Within |x| + |y| <= 1 of the map z = 1 - (|x| + |y|)^2 (Clarberg 2008).
      const double x = 0.25 * (2 * (i + 0.5) / kSteps - 1), y = 0.25 * (2 * (j + 0.5) / kSteps - 1);
      cosines += 1 - std::pow(std::abs(x) + std::abs(y), 2);
    }
  const double irradiance = 2 * cosines / (kSteps * kSteps) * (4 * std::numbers::pi / 16);
  for (const char* direct : {"true", "false"}) {
    const auto [mean, error] = channel_mean(under_environment(folder.name_of("e.exr"), direct), 1);
    const double expected = 0.5 * irradiance / std::numbers::pi;
    EXPECT_NEAR(mean, expected, 5 * error + 1e-3 * expected) << direct;
    EXPECT_LT(error, 0.01 * expected);
  }
}

TEST(ImageEnvironment, ThatIsNotSquareIsRefused) {
  const TestFolder folder("environment");
  write_image(folder.name_of("e.exr"), Image(4, 2, {"R", "G", "B"}), {"linear sRGB", {}});
  const std::string error = error_of([&] { under_environment(folder.name_of("e.exr"), "true"); });
  EXPECT_NE(error.find("the image is 4 x 2: an environment is square"), std::string::npos) << error;
}

}  // namespace
}  // namespace frond
