#include <gtest/gtest.h>

#include "tests/support/render_text.h"

namespace frond {
namespace {

using test::render_text;

/// A binary tree of mixtures, `levels` high, whose leaves are `plugin`. The root is called "m1".
std::string mixtures(int levels, const std::string& plugin) {
  std::string text;
  const int first_leaf = 1 << levels;
  for (int i = 2 * first_leaf - 1; i >= first_leaf; --i)
    text += fmt::format("MakeNamedMaterial \"m{}\" \"string type\" {}\n", i, plugin);
  for (int i = first_leaf - 1; i >= 1; --i)
    text += fmt::format("MakeNamedMaterial \"m{}\" \"string type\" \"mix\" \"string materials\" [\"m{}\" \"m{}\"]\n", i,
                        2 * i, 2 * i + 1);
  return text;
}

std::string mix_scene(const std::string& materials) {
  return fmt::format(R"(
LookAt .6 0 .8  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-.1 .1 -.1 .1]
Film "rgb" "integer xresolution" 4 "integer yresolution" 4
Sampler "independent"
PixelFilter "box"
Integrator "path" "integer maxdepth" 4
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
{}NamedMaterial "m1"
Shape "trianglemesh" "point3 P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0] "integer indices" [0 1 2  0 2 3]
)",
                     materials);
}

TEST(Mix, OfManyStochasticMaterialsHasRoomForThem) {
  const std::string abm = R"("abm" "string specimen" "soybean")";
  for (const std::string wavelengths : {"smpte", "hero"}) {
    const Film film = render_text(mix_scene(mixtures(4, abm)), {.samples = 64, .wavelengths = wavelengths});
    EXPECT_EQ(film.not_finite(), 0u);
    // A mixture of a material with itself equals the material.
    const Film one = render_text(mix_scene(mixtures(0, abm)), {.samples = 64, .wavelengths = wavelengths});
    for (size_t c = 0; c < 3; ++c) {
      const auto a = test::channel_mean(film, c), b = test::channel_mean(one, c);
      EXPECT_GT(b.mean, 0);
      EXPECT_LT(std::abs(a.mean - b.mean), 5 * std::hypot(a.error, b.error)) << wavelengths << ", channel " << c;
    }
  }
}

}  // namespace
}  // namespace frond
