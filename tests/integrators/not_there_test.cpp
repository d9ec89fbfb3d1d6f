#include <gtest/gtest.h>

#include "tests/support/render_text.h"

/// Materials that return no BSDF: invisible surfaces.
namespace frond {
namespace {

using test::channel_mean;
using test::render_text;

struct NotThere final : Material {
  explicit NotThere(const Params&) {}
  const Bsdf* evaluate(const Hit&, const SampledWavelengths&, Arena&) const override { return nullptr; }
};
const MaterialInfo kNotThere{
    {"material", "not_there", "", "", {}}, make_material<NotThere>, LeafModel{.reference = "not_there", .cost = 1}};

/// Two spheres around the origin, the inner one within the view of the camera.
constexpr const char* kSpheres = R"(
Material "not_there"
Shape "sphere" "float radius" 0.3
Shape "sphere" "float radius" 2
)";

Film render_with(const std::string& world, int max_depth) {
  return render_text(fmt::format(R"(
LookAt 0 0 1  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-.2 .2 -.2 .2]
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Sampler "independent"
Integrator "path" "integer maxdepth" {}
WorldBegin
LightSource "infinite"
{}
{})",
                                 max_depth, kSpheres, world),
                     {.samples = 256, .materials = {&kNotThere}});
}

TEST(NotThere, TheSkyBehindIsSeenAndNoLeafIs) {
  const Film film = render_with("", 0);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_NEAR(film.mean(x, y)[1], 1, 1e-5);
  EXPECT_EQ(film.foliar_ratio(), 0);
}

/// A grey disk between them: the inner sphere's front is before it, the outer one around all. One scattering event is
/// enough for its light, for no surface that is not there counts as one. Cosine-weighted directions have no noise here.
TEST(NotThere, IsNoScatteringEvent) {
  for (const int max_depth : {1, 3}) {
    const Film film =
        render_with("Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] Shape \"disk\" \"float radius\" 1", max_depth);
    EXPECT_NEAR(channel_mean(film, 1).mean, 0.5, 1e-5);
  }
}

/// A lamp outside the outer sphere lights the disk inside. 5 standard errors: a false alarm in 1.7 million.
TEST(NotThere, LightsOfASceneAreFoundThroughIt) {
  const std::string lamp = R"(
AttributeBegin
  Material "diffuse"
  Translate 0 0 5
  AreaLightSource "diffuse" "float scale" 3
  ReverseOrientation
  Shape "disk" "float radius" 2
AttributeEnd
)";
  const std::string disk = "Material \"diffuse\" Shape \"disk\" \"float radius\" 1 \"float height\" -0.5";
  const auto with = channel_mean(render_with(lamp + disk, 1), 1);
  const auto without = channel_mean(render_text(fmt::format(R"(
LookAt 0 0 1  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-.2 .2 -.2 .2]
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Sampler "independent"
Integrator "path" "integer maxdepth" 1
WorldBegin
LightSource "infinite"
{}{})",
                                                            lamp, disk),
                                                {.samples = 256}),
                                    1);
  EXPECT_NEAR(with.mean, without.mean, 5 * std::hypot(with.error, without.error));
}

}  // namespace
}  // namespace frond
