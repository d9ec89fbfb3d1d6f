// The parameter "regularize" of the integrators, and glass that parts the wavelengths of a path.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/render_text.h"

namespace frond {
namespace {

using test::channel_mean;
using test::render_text;

/// A ball on a floor under a lamp, seen from above; the light of the caustic comes through the ball.
std::string ball(const std::string& integrator, const std::string& more, const std::string& material,
                 const std::string& floor = "\"rgb reflectance\" [.5 .5 .5]") {
  return fmt::format(R"(
LookAt 0 -6 4  0 0 0  0 0 1
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
Sampler "lattice"
PixelFilter "box"
Integrator "{}" "integer maxdepth" 6 {}
WorldBegin
AttributeBegin
AreaLightSource "diffuse" "spectrum L" "stdillum-D65" "float scale" 50
Translate 0 0 5
Shape "sphere" "float radius" .2
AttributeEnd
Material "diffuse" {}
Shape "trianglemesh" "point3 P" [-3 -3 0  3 -3 0  3 3 0  -3 3 0] "integer indices" [0 1 2  0 2 3]
Material {}
Translate 0 0 1.2
Shape "sphere" "float radius" 1
)",
                     integrator, more, floor, material);
}

bool same_colors(const Film& a, const Film& b) {
  const Crop& c = a.settings().crop;
  for (int y = c.y0; y < c.y1; ++y)
    for (int x = c.x0; x < c.x1; ++x)
      if (a.mean(x, y) != b.mean(x, y)) return false;
  return true;
}

TEST(Regularize, WideLobesStayToTheBit) {
  for (const char* integrator : {"path", "volpath"})
    for (const char* material : {"\"conductor\" \"float roughness\" .16", "\"dielectric\" \"float roughness\" .16",
                                 "\"coateddiffuse\" \"float roughness\" .16", "\"diffuse\"", "\"thindielectric\""}) {
      const Film off = render_text(ball(integrator, "", material)),
                 on = render_text(ball(integrator, "\"bool regularize\" true", material));
      EXPECT_TRUE(same_colors(off, on)) << integrator << ' ' << material;
    }
}

/// A floor that a small lamp lights by a mirror above it alone: scattered rays find the lamp by chance, light samples
/// not at all, unless the mirror has a wide lobe. Relative variance is measured as a nineteenth or less; the limit is a
/// quarter.
TEST(Regularize, CausticsHaveLessNoise) {
  for (const char* integrator : {"path", "volpath"}) {
    const auto result = [&](const char* more) {
      const std::string text = fmt::format(R"(
LookAt 1.2 0 .5  1.2 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-.1 .1 -.1 .1]
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Sampler "independent"
PixelFilter "box"
Integrator "{}" "integer maxdepth" 3 {}
WorldBegin
Material "diffuse" "spectrum reflectance" [300 .5 900 .5]
Shape "disk" "float radius" 3
Material "conductor"
Shape "disk" "float height" 2 "float radius" 3
Material "diffuse" "spectrum reflectance" [300 0 900 0]
Shape "disk" "float height" .9 "float radius" .5
AreaLightSource "diffuse" "spectrum L" "stdillum-D65" "float scale" 100
Translate 0 0 1
Shape "sphere" "float radius" .05
)",
                                           integrator, more);
      return channel_mean(render_text(text, {.samples = 1024}), 1);
    };
    const auto off = result(""), on = result("\"bool regularize\" true");
    EXPECT_LT(4 * on.error * on.error / (on.mean * on.mean), off.error * off.error / (off.mean * off.mean))
        << integrator;
  }
}

/// Camera rays that only specular surfaces have scattered see the glass as it is: on a black floor nothing changes.
TEST(Regularize, SpecularPathsStayToTheBit) {
  const std::string black = "\"spectrum reflectance\" [300 0 900 0]", sky = "LightSource \"infinite\"\nMaterial ";
  const auto scene = [&](const char* more) {
    std::string text = ball("path", more, "\"dielectric\"", black);
    return text.replace(text.find("Material \"diffuse\""), 9, sky);
  };
  EXPECT_TRUE(same_colors(render_text(scene("")), render_text(scene("\"bool regularize\" true"))));
}

/// The wavelength that continues in a dispersive glass has the stratification of the sampler: images of hero
/// wavelengths are less noisy than of lanes drawn at random (measured: half of the error).
TEST(Dispersion, WavelengthsAreStratified) {
  const std::string sky = "LightSource \"infinite\"\nMaterial ";
  const auto error = [&](const char* sampler) {
    std::string text = ball("path", "", "\"dielectric\" \"spectrum eta\" \"glass-F11\"");
    text.replace(text.find("lattice"), 7, sampler).replace(text.find("Material \"diffuse\""), 9, sky);
    text.replace(text.find("scale\" 50"), 9, "scale\" 1e-6");
    constexpr uint64_t kSeeds = 8;
    double square = 0;
    std::vector<Film> films;
    for (uint64_t seed = 1; seed <= kSeeds; ++seed)
      films.push_back(render_text(text, {.samples = 64, .seed = seed, .wavelengths = "hero"}));
    for (int y = 2; y < 12; ++y)
      for (int x = 6; x < 10; ++x) {
        double sum = 0, squares = 0;
        for (const Film& f : films) sum += f.mean(x, y)[0], squares += f.mean(x, y)[0] * f.mean(x, y)[0];
        square += squares - sum * sum / kSeeds;
      }
    return std::sqrt(square);
  };
  EXPECT_LT(error("lattice"), 0.7 * error("independent"));
}

}  // namespace
}  // namespace frond
