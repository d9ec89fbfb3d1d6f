#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/render_text.h"

namespace frond {
namespace {

using test::channel_mean;
using test::render_text;

std::string seen_from(double distance, double extent, const std::string& shape) {
  return fmt::format(R"(
LookAt 0 0 {}  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-{} {} -{} {}]
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
Sampler "independent"
PixelFilter "box"
Integrator "path" "integer maxdepth" 1
WorldBegin
LightSource "distant" "point3 from" [0 .6 .8] "point3 to" [0 0 0] "spectrum L" "stdillum-D65"
Material "diffuse"
{}
)",
                     distance, extent, extent, extent, extent, shape);
}

/// No surface shades itself: neither large ones close to the origin nor small ones far from the camera.
TEST(OffsetOrigin, APlaneLooksTheSameAtAnySize) {
  // The turn leaves no coordinate exact; the normal comes back to +z by the second turn.
  for (const double size : {1.0, 100.0, 10000.0}) {
    const std::string plane = fmt::format(
        "Rotate -31 1 2 0 Rotate 31 1 2 0 Shape \"trianglemesh\" \"point3 P\" [-{0} -{0} 0  {0} -{0} 0  {0} {0} 0  "
        "-{0} {0} 0] "
        "\"integer indices\" [0 1 2  0 2 3]",
        size);
    for (const std::string& scene :
         {plane, "ObjectBegin \"o\"\n" + plane + "\nObjectEnd Rotate 17 0 0 1 ObjectInstance \"o\""}) {
      const auto [mean, error] = channel_mean(render_text(seen_from(1, 0.5, scene)), 1);
      EXPECT_NEAR(mean, 0.5 * 0.8 / std::numbers::pi, 1e-4) << size;
    }
  }
}

TEST(OffsetOrigin, ASphereLooksTheSameFromAnyDistance) {
  const std::string sphere = "Shape \"sphere\" \"float radius\" .5";
  // Over the middle of the disk alone, where no camera ray misses.
  const auto near = channel_mean(render_text(seen_from(1, 0.3, sphere), {.samples = 64}), 1);
  for (const double distance : {100.0, 10000.0}) {
    const auto far = channel_mean(render_text(seen_from(distance, 0.3, sphere), {.samples = 64}), 1);
    // 5 standard errors of the difference: a false alarm in 1.7 million. Float positions at 10^4 are 1e-3 apart.
    EXPECT_NEAR(far.mean, near.mean, 5 * std::hypot(near.error, far.error) + 1e-3 * near.mean) << distance;
  }
}

TEST(OffsetOrigin, AlphaCountsEverySheetOfASphere) {
  const std::string sky = "LightSource \"infinite\" \"spectrum L\" \"stdillum-D65\"\n";
  const std::string sphere =
      "Material \"diffuse\" \"spectrum reflectance\" [360 0 2500 0]\nShape \"sphere\" \"float alpha\" .5";
  const auto [mean, error] = channel_mean(render_text(seen_from(3, 0.5, sky + sphere), {.samples = 64}), 1);
  EXPECT_NEAR(mean, 0.25, 5 * error);
  EXPECT_LT(error, 0.005);
}

}  // namespace
}  // namespace frond
