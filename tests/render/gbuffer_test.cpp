// Film "gbuffer": the channels of pbrt-v4 under its names.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "render/film/image_format.h"
#include "tests/render/render_scene.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::Contains;
using ::testing::Not;

class Gbuffer : public ::testing::Test {
 protected:
  Image render(const std::string& wavelengths = "hero") const {
    std::string text = test::a_scene();
    text.replace(text.find("Film \"rgb\""), 10, "Film \"gbuffer\" \"string coordinatesystem\" \"world\"");
    const RenderPart part =
        test::SceneRender{.wavelengths = wavelengths}.part(folder_.write("scene.pbrt", text), {0, 16});
    return film_image(part.film, part.header.image);
  }
  TestFolder folder_{"gbuffer"};
};

TEST_F(Gbuffer, HasTheNamesOfPbrt) {
  const Image image = render();
  for (const char* name : {"R",
                           "G",
                           "B",
                           "Albedo.R",
                           "Albedo.G",
                           "Albedo.B",
                           "P.X",
                           "P.Y",
                           "P.Z",
                           "N.X",
                           "N.Y",
                           "N.Z",
                           "Ns.X",
                           "Ns.Y",
                           "Ns.Z",
                           "u",
                           "v",
                           "Variance.R",
                           "Variance.G",
                           "Variance.B",
                           "RelativeVariance.R",
                           "RelativeVariance.G",
                           "RelativeVariance.B",
                           "Z",
                           "materialId",
                           "instanceId",
                           "samples"})
    EXPECT_THAT(image.channels, Contains(name));
  for (const char* name : {"albedo.R", "normal.X"}) EXPECT_THAT(image.channels, Not(Contains(name)));
}

/// On the floor, whose front is below: the variance of samples is the variance of their mean times their number.
TEST_F(Gbuffer, HasTheValuesOfTheHit) {
  const Image image = render();
  const auto at = [&](const char* name) { return double(image.at(20, 25, *image.channel(name))); };
  EXPECT_NEAR(at("N.Y"), 1, 1e-6);
  EXPECT_NEAR(at("Ns.Y"), 1, 1e-6);
  EXPECT_NEAR(at("P.Y"), -0.5, 1e-6);
  EXPECT_NEAR(at("u"), (at("P.Z") + 2) / 4, 1e-5);
  EXPECT_NEAR(at("v"), (at("P.Z") - at("P.X")) / 4, 1e-5);
  EXPECT_GT(at("Variance.G"), 0);
  EXPECT_NEAR(at("Variance.G"), at("variance.G") * at("samples"), 1e-5 * at("Variance.G"));
  EXPECT_NEAR(at("RelativeVariance.G"), at("Variance.G") / at("G"), 1e-5 * at("RelativeVariance.G"));
}

TEST_F(Gbuffer, OfBandsHasNoColors) {
  const Image image = render("bands,wavelengths=550,650");
  EXPECT_THAT(image.channels, Contains("Ns.X"));
  EXPECT_THAT(image.channels, Not(Contains("Albedo.R")));
  EXPECT_THAT(image.channels, Not(Contains("Variance.R")));
}

}  // namespace
}  // namespace frond
