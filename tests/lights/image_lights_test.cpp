#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "core/log.h"
#include "core/math/equal_area.h"
#include "core/math/random.h"
#include "image/image_file.h"
#include "integrators/registry.h"
#include "lights/light_image.h"
#include "materials/registry.h"
#include "scene/format/parser.h"
#include "scene/scene.h"
#include "scene/scene_options.h"
#include "spectra/cie.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kPiD = std::numbers::pi;

/// A scene in the text of a test, and its messages.
struct Loaded {
  explicit Loaded(const std::string& text, const std::string& wavelengths = "smpte") {
    class Keep final : public Log {
     public:
      explicit Keep(std::vector<std::string>& to) : to_(to) {}
      void info(std::string_view) const override {}
      void warn(const Location&, std::string_view message) const override { to_.emplace_back(message); }

     private:
      std::vector<std::string>& to_;
    };
    const Keep log(warnings);
    SceneDescription description = parse_scene_text(text, "t", log);
    ThreadPool pool(1);
    set_wavelengths(description, wavelengths);
    scene.emplace(description, make_registry(builtin_materials(), builtin_integrators()), pool, log);
  }
  const Light& light() const { return *scene->lights()[0]; }
  SampledWavelengths lambda() const { return scene->wavelengths().sample(0.5f); }

  std::vector<std::string> warnings;
  std::optional<Scene> scene;
};

Loaded with_light(const std::string& light) { return Loaded("WorldBegin LightSource " + light); }

/// Grey but for a red upper left texel.
Image marked(int width, int height, float grey) {
  Image image(width, height, {"R", "G", "B"});
  for (float& v : image.pixels) v = grey;
  image.at(0, 0, 1) = image.at(0, 0, 2) = 0;
  return image;
}

Image even(int width, int height, float grey) {
  Image image = marked(width, height, grey);
  image.at(0, 0, 1) = image.at(0, 0, 2) = grey;
  return image;
}

double relative_to_white(const SampledSpectrum& s, const SampledWavelengths& lambda) {
  return double(s[1]) / double(unit_d65()->at(lambda.nm[1]));
}

TEST(EqualArea, GoesThereAndBack) {
  for (int i = 0; i < 50; ++i)
    for (int j = 0; j < 50; ++j) {
      const Vec2 uv{(float(i) + 0.5f) / 50, (float(j) + 0.5f) / 50};
      const Vec3 d = sphere_from_square(uv);
      EXPECT_NEAR(length(d), 1, 1e-5);
      const Vec2 back = square_from_sphere(d);
      EXPECT_NEAR(back.x, uv.x, 1e-4);
      EXPECT_NEAR(back.y, uv.y, 1e-4);
    }
}

/// A step across the edge leads on where the edge is sewn.
TEST(EqualArea, WrapsAroundItsEdges) {
  for (const float t : {0.1f, 0.4f, 0.8f})
    for (const auto& [in, out] : {std::pair(Vec2{0.001f, t}, Vec2{-0.001f, t}),
                                  {{0.999f, t}, {1.001f, t}},
                                  {{t, 0.001f}, {t, -0.001f}},
                                  {{t, 0.999f}, {t, 1.001f}}}) {
      const Vec3 a = sphere_from_square(in), b = sphere_from_square(wrapped_on_square(out));
      EXPECT_LT(length(a - b), 0.02);
    }
}

TEST(ImageSky, HasTwiceTheIlluminanceThatIsAskedForAsInPbrt) {
  const TestFolder folder("lights");
  write_image(folder.name_of("sky.exr"), even(64, 64, 0.3f), {"linear sRGB", {}});
  const Loaded sky = with_light(
      fmt::format("\"infinite\" \"string filename\" \"{}\" \"float illuminance\" 5", folder.name_of("sky.exr")));
  const auto& light = dynamic_cast<const EnvironmentLight&>(sky.light());
  EXPECT_NEAR(relative_to_white(light.radiance({}, {0, 0, 1}, sky.lambda()), sky.lambda()), 10 / kPiD, 0.02);
  EXPECT_THAT(sky.warnings, Contains(HasSubstr("twice")));
}

TEST(ImageSky, RefusesAMapByLatitudeAndLongitude) {
  const TestFolder folder("lights");
  write_image(folder.name_of("sky.exr"), even(16, 8, 1), {"linear sRGB", {}});
  EXPECT_THAT(
      error_of([&] { with_light(fmt::format("\"infinite\" \"string filename\" \"{}\"", folder.name_of("sky.exr"))); }),
      HasSubstr("makeequiarea"));
}

TEST(ImageSky, IsNotKnownInTheInfrared) {
  const TestFolder folder("lights");
  write_image(folder.name_of("sky.exr"), even(16, 16, 1), {"linear sRGB", {}});
  for (const std::string kind : {"infinite", "projection"})
    EXPECT_THAT(
        error_of([&] {
          Loaded("WorldBegin\nLightSource \"" + kind + "\" \"string filename\" \"" + folder.name_of("sky.exr") + '"',
                 "bands,wavelengths=1650");
        }),
        HasSubstr("t:2:13: \"emission\" is known from 360 to 830 nm, 1650 nm was asked for"))
        << kind;
}

/// By directions evenly over the sphere.
template <class Value>
double over_the_sphere(const Value& value) {
  constexpr int kSteps = 600;
  double sum = 0;
  for (int i = 0; i < kSteps * kSteps; ++i)
    sum += value(sphere_from_square({(float(i % kSteps) + 0.5f) / kSteps, (float(i / kSteps) + 0.5f) / kSteps}));
  return sum * 4 * kPiD / (double(kSteps) * kSteps);
}

/// Values of an image of the sphere: 1 on average, and different everywhere.
float ramp(const Vec3& w) { return 1 + 0.5f * w.x + 0.3f * w.y - 0.2f * w.z; }

void write_ramp(const std::string& name, int size) {
  Image image(size, size, {"R", "G", "B"});
  for (int i = 0; i < size * size; ++i) {
    const Vec2 uv{(float(i % size) + 0.5f) / float(size), (float(i / size) + 0.5f) / float(size)};
    for (size_t c = 0; c < 3; ++c) image.at(i % size, i / size, c) = ramp(sphere_from_square(uv));
  }
  write_image(name, image, {"linear sRGB", {}});
}

constexpr const char* kStretched = "WorldBegin Rotate 30 1 2 3 Scale 1 .7 4 LightSource ";

TEST(ImageSky, HasItsDensitiesWhateverTheTransform) {
  const TestFolder folder("lights");
  write_ramp(folder.name_of("sky.exr"), 64);
  for (const std::string& place : {std::string(kStretched), std::string("WorldBegin Scale 2 -2 2 LightSource ")}) {
    const Loaded sky(place + fmt::format("\"infinite\" \"string filename\" \"{}\"", folder.name_of("sky.exr")));
    const auto& light = dynamic_cast<const EnvironmentLight&>(sky.light());
    const bool is_stretched = place == kStretched;
    EXPECT_EQ(sky.warnings.size(), is_stretched ? 1u : 0u);
    for (const bool competing : {false, true}) {
      const auto pdf = [&](const Vec3& w) { return competing ? light.compensated_pdf({}, w) : light.pdf({}, w); };
      EXPECT_NEAR(over_the_sphere([&](const Vec3& w) { return double(pdf(w)); }), 1, 5e-3);
      double sum = 0;
      constexpr int kSteps = 200;
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const Vec2 u{(float(i % kSteps) + 0.5f) / kSteps, (float(i / kSteps) + 0.5f) / kSteps};
        const auto s = competing ? light.sample_compensated({}, u, sky.lambda()) : light.sample({}, u, sky.lambda());
        ASSERT_TRUE(s);
        if (i % 37 == 0) {
          EXPECT_NEAR(pdf(s->wi) / s->pdf, 1, 0.1) << "but for points at the edge of a texel";
        }
        if (!competing) sum += relative_to_white(s->radiance, sky.lambda()) * double(std::max(0.f, s->wi.z) / s->pdf);
      }
      if (competing) continue;
      const double wanted = over_the_sphere([&](const Vec3& w) {
        return relative_to_white(light.radiance({}, w, sky.lambda()), sky.lambda()) * double(std::max(0.f, w.z));
      });
      EXPECT_NEAR(sum / (kSteps * kSteps) / wanted, 1, 5e-3);
    }
  }
}

TEST(PointLightsOfImages, GiveOffTheirPowerWhateverTheTransform) {
  const TestFolder folder("lights");
  write_ramp(folder.name_of("g.exr"), 64);
  for (const char* kind : {"\"goniometric\"", "\"projection\" \"float fov\" 80"}) {
    const Loaded loaded(kStretched +
                        fmt::format("{} \"string filename\" \"{}\" \"float power\" 5", kind, folder.name_of("g.exr")));
    const double given = over_the_sphere([&](const Vec3& w) {
      const auto s = loaded.light().sample(w, {}, loaded.lambda());
      return s ? relative_to_white(s->radiance, loaded.lambda()) : 0.0;
    });
    EXPECT_NEAR(given, 5, 0.05) << kind;
    EXPECT_NEAR(loaded.light().power(1), 5, 1e-3) << kind;
  }
}

/// As in pbrt-v4: 0 or less states none.
TEST(Lights, TotalsThatAreNotPositiveCountAsNotGiven) {
  const TestFolder folder("lights");
  write_ramp(folder.name_of("a.exr"), 8);
  const std::string image = fmt::format("\"string filename\" \"{}\"", folder.name_of("a.exr"));
  const std::string portal = "\"point3 portal\" [-1 -2 3  -1 2 3  1 2 3  1 -2 3]";
  for (const auto& [light, total] :
       std::vector<std::pair<std::string, std::string>>{{"LightSource \"point\"", "power"},
                                                        {"LightSource \"spot\"", "power"},
                                                        {"LightSource \"distant\"", "illuminance"},
                                                        {"LightSource \"infinite\"", "illuminance"},
                                                        {"LightSource \"infinite\" " + image, "illuminance"},
                                                        {"LightSource \"infinite\" " + portal, "illuminance"},
                                                        {"LightSource \"infinite\" " + portal + image, "illuminance"},
                                                        {"LightSource \"projection\" " + image, "power"},
                                                        {"LightSource \"goniometric\" " + image, "power"},
                                                        {"AreaLightSource \"diffuse\"", "power"},
                                                        {"AreaLightSource \"diffuse\" " + image, "power"}}) {
    const auto loaded = [&, text = &light, name = &total](const std::string& value) {
      return Loaded("WorldBegin " + *text + (value.empty() ? "" : fmt::format(" \"float {}\" {}", *name, value)) +
                    (text->starts_with("Area")
                         ? " Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0  3 1 0  3 3 "
                           "0] \"integer indices\" [0 1 2 3  1 4 3 5]"
                         : ""));
    };
    const Loaded own = loaded("");
    EXPECT_TRUE(own.warnings.empty()) << light;
    for (const char* value : {"0", "-1"}) {
      const Loaded same = loaded(value);
      EXPECT_EQ(same.light().power(1), own.light().power(1)) << light;
      EXPECT_EQ(same.scene->lights().size(), own.scene->lights().size()) << light;
      EXPECT_THAT(same.warnings, ::testing::ElementsAre(HasSubstr("counts as not given"))) << light;
    }
    EXPECT_NE(loaded("1.5").light().power(1), own.light().power(1)) << light;
  }
}

constexpr const char* kPortal = "\"point3 portal\" [-1 -2 3  -1 2 3  1 2 3  1 -2 3]";

/// Seen from the origin through a rectangle of half sides a and b at a distance d, whose solid angle is known.
void expect_portal(const Loaded& loaded, double radiance) {
  const double a = 1, b = 2, d = 3;
  const double solid_angle = 4 * std::asin(a * b / std::sqrt((a * a + d * d) * (b * b + d * d)));
  const auto& light = dynamic_cast<const EnvironmentLight&>(loaded.light());
  EXPECT_FALSE(light.is_distant());
  double sum = 0;
  constexpr int kSteps = 128;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const Vec2 u{(float(i % kSteps) + 0.5f) / kSteps, (float(i / kSteps) + 0.5f) / kSteps};
    const auto s = light.sample({}, u, loaded.lambda());
    ASSERT_TRUE(s);
    const Vec3 at = s->wi * (3 / s->wi.z);
    EXPECT_LE(std::abs(at.x), 1.0001f);
    EXPECT_LE(std::abs(at.y), 2.0001f);
    if (i % 37 == 0) {
      EXPECT_NEAR(light.pdf({}, s->wi) / s->pdf, 1, 0.2) << "but for points at the edge of a cell";
    }
    sum += relative_to_white(s->radiance, loaded.lambda()) / double(s->pdf);
  }
  EXPECT_NEAR(sum / (kSteps * kSteps) / (radiance * solid_angle), 1, 2e-3);
  const auto seen = [&](const Vec3& from, const Vec3& to) {
    return relative_to_white(light.radiance(from, normalize(to - from), loaded.lambda()), loaded.lambda());
  };
  EXPECT_NEAR(seen({}, {0.9f, 1.9f, 3}), radiance, 0.01 * radiance);
  EXPECT_EQ(seen({}, {1.1f, 1.9f, 3}), 0);
  EXPECT_EQ(seen({}, {0, 0, -3}), 0);
  EXPECT_NEAR(seen({5, 0, 0}, {0.9f, 1.9f, 3}), radiance, 0.01 * radiance);
  EXPECT_EQ(seen({0, 0, 4}, {0, 0, 5}), 0) << "from behind";
  EXPECT_FALSE(light.sample({0, 0, 4}, {0.5f, 0.5f}, loaded.lambda()));
  EXPECT_EQ(light.pdf({0, 0, 4}, {0, 0, 1}), 0);
  EXPECT_EQ(light.pdf({}, {0, 0, -1}), 0);
}

// The corners in turn: y runs first, so that the axis, third edge times first, points to +z.
TEST(Portal, IsSeenThroughItsRectangleAlone) {
  expect_portal(with_light(fmt::format("\"infinite\" \"rgb L\" [2 2 2] {}", kPortal)), 2);
}

TEST(Portal, ShowsAnImage) {
  const TestFolder folder("lights");
  write_image(folder.name_of("sky.exr"), even(32, 32, 0.5f), {"linear sRGB", {}});
  expect_portal(with_light(fmt::format("\"infinite\" \"string filename\" \"{}\" \"float scale\" 3 {}",
                                       folder.name_of("sky.exr"), kPortal)),
                1.5);
}

TEST(Portal, ShowsAnImageAsItIsTurned) {
  const TestFolder folder("lights");
  write_ramp(folder.name_of("sky.exr"), 128);
  const Loaded loaded(fmt::format("WorldBegin Rotate 50 1 -2 .5 LightSource \"infinite\" \"string filename\" \"{}\" {}",
                                  folder.name_of("sky.exr"), kPortal));
  const auto& light = dynamic_cast<const EnvironmentLight&>(loaded.light());
  const Transform back = Transform::rotate(50, {1, -2, 0.5f}).inverse();
  double wanted = 0, sampled = 0;
  constexpr int kSteps = 100;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const Vec2 u{(float(i % kSteps) + 0.5f) / kSteps, (float(i / kSteps) + 0.5f) / kSteps};
    const Vec3 to{2 * u.x - 1, 4 * u.y - 2, 3}, w = normalize(to);
    const float seen = float(relative_to_white(light.radiance({}, w, loaded.lambda()), loaded.lambda()));
    EXPECT_NEAR(seen, ramp(back.vector(w)), 0.03f);
    wanted += double(ramp(back.vector(w)) * w.z / dot(to, to)) * 8 / (kSteps * kSteps);
    const auto s = light.sample({}, u, loaded.lambda());
    ASSERT_TRUE(s);
    sampled += relative_to_white(s->radiance, loaded.lambda()) / double(s->pdf) / (kSteps * kSteps);
  }
  EXPECT_NEAR(sampled / wanted, 1, 5e-3);
}

/// pbrt-v4 takes such a light for an image of one texel; measured with it: 1.591 for 10 lx.
TEST(Portal, ItsIlluminanceIsThatOfAnImageOfOneTexel) {
  const Loaded loaded = with_light(fmt::format("\"infinite\" \"rgb L\" [1 1 1] \"float illuminance\" 10 {}", kPortal));
  const auto& light = dynamic_cast<const EnvironmentLight&>(loaded.light());
  EXPECT_NEAR(relative_to_white(light.radiance({}, {0, 0, 1}, loaded.lambda()), loaded.lambda()), 10 / (2 * kPiD),
              0.01);
  EXPECT_THAT(loaded.warnings, Contains(HasSubstr("half of what gives this illuminance")));
}

TEST(Portal, IsARectangle) {
  for (const char* points :
       {"0 0 0 0 1 0 1 1 0", "0 0 0 0 1 0 1 2 0 1 0 0", "0 0 0 0 0 0 0 0 0 0 0 0", "0 0 0 1 1 0 0 1 0 1 0 0"})
    EXPECT_THAT(error_of([&] { with_light(fmt::format("\"infinite\" \"point3 portal\" [{}]", points)); }),
                HasSubstr("\"portal\""))
        << points;
}

TEST(Projection, ThrowsItsImageUprightAlongZ) {
  const TestFolder folder("lights");
  write_image(folder.name_of("slide.exr"), marked(8, 4, 0.5f), {"linear sRGB", {}});
  const Loaded slide = with_light(fmt::format(
      "\"projection\" \"string filename\" \"{}\" \"float fov\" 90 \"float scale\" 3", folder.name_of("slide.exr")));
  const Light& light = slide.light();
  const SampledWavelengths lambda = slide.lambda();
  const auto at = [&](const Vec3& p) {
    const auto s = light.sample(p, {}, lambda);
    return s ? s->radiance : SampledSpectrum();
  };
  // At z = 1 the image reaches from -2 to 2 and from -1 to 1; intensity over the squared distance arrives.
  EXPECT_NEAR(relative_to_white(at({0.1f, 0.1f, 1}), lambda), 1.5 / 1.02, 0.01);
  EXPECT_NEAR(relative_to_white(at({1.9f, -0.9f, 1}), lambda), 1.5 / (1 + 1.9 * 1.9 + 0.81), 0.01);
  const SampledSpectrum red = at({-1.9f, 0.9f, 1});  // lanes are red, green and blue
  EXPECT_GT(red[0], 5 * red[1]);
  for (const Vec3& p : {Vec3{2.1f, 0, 1}, {0, 1.1f, 1}, {0, 0, -1}, {0, 0, 0}}) EXPECT_TRUE(at(p).is_black());
  ASSERT_TRUE(light.bounds());
  EXPECT_NEAR(light.bounds()->cos_spread, 1 / std::sqrt(6.f), 1e-5);
  EXPECT_EQ(light.bounds()->axis, (Vec3{0, 0, 1}));
}

TEST(Projection, GivesOffThePowerThatIsAskedFor) {
  const TestFolder folder("lights");
  write_image(folder.name_of("slide.exr"), even(64, 64, 0.5f), {"linear sRGB", {}});
  const Loaded slide = with_light(fmt::format(
      "\"projection\" \"string filename\" \"{}\" \"float fov\" 90 \"float power\" 7", folder.name_of("slide.exr")));
  EXPECT_NEAR(slide.light().power(1), 7, 1e-4);
  // A sixth of all directions.
  const auto s = slide.light().sample({0, 0, 1}, {}, slide.lambda());
  ASSERT_TRUE(s);
  EXPECT_NEAR(relative_to_white(s->radiance, slide.lambda()), 7 / (4 * kPiD / 6), 0.005);
}

TEST(Goniometric, OfAnEvenImageIsAPointLight) {
  const TestFolder folder("lights");
  write_image(folder.name_of("g.exr"), even(8, 8, 0.5f), {"linear sRGB", {}});
  const std::string where = "Translate 1 2 3 LightSource ";
  const Loaded image("WorldBegin " + where +
                     fmt::format("\"goniometric\" \"string filename\" \"{}\" \"rgb I\" [3 2 1] "
                                 "\"float power\" 5",
                                 folder.name_of("g.exr"))),
      point("WorldBegin " + where + "\"point\" \"rgb I\" [3 2 1] \"float power\" 5");
  for (const Vec3& p : {Vec3{0, 0, 0}, {4, 1, 9}, {1, 2, 8}}) {
    const auto a = image.light().sample(p, {}, image.lambda()), b = point.light().sample(p, {}, point.lambda());
    ASSERT_TRUE(a && b);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a->radiance[i] / b->radiance[i], 1, 1e-5);
  }
  EXPECT_NEAR(image.light().power(1) / point.light().power(1), 1, 1e-6);
}

/// Its pole is +y: the middle of the image.
TEST(Goniometric, HasItsImageAroundY) {
  const TestFolder folder("lights");
  Image dot = even(9, 9, 0);
  for (size_t c = 0; c < 3; ++c) dot.at(4, 4, c) = 1;
  write_image(folder.name_of("g.exr"), dot, {"linear sRGB", {}});
  const Loaded light = with_light(fmt::format("\"goniometric\" \"string filename\" \"{}\"", folder.name_of("g.exr")));
  EXPECT_TRUE(light.light().sample({0, 1, 0}, {}, light.lambda()));
  for (const Vec3& p : {Vec3{0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0}})
    EXPECT_FALSE(light.light().sample(p, {}, light.lambda()));
}

constexpr const char* kSquare =
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0] \"point2 uv\" [0 0 1 0 1 1 0 1] \"integer indices\" "
    "[0 1 2 0 2 3]";

TEST(ImageAreaLight, HasItsFirstRowAtTheTop) {
  const TestFolder folder("lights");
  write_image(folder.name_of("a.exr"), marked(4, 4, 0.5f), {"linear sRGB", {}});
  const Loaded loaded(
      fmt::format("WorldBegin AreaLightSource \"diffuse\" \"string filename\" \"{}\" \"float scale\" 2 {}",
                  folder.name_of("a.exr"), kSquare));
  const auto& light = dynamic_cast<const AreaLight&>(loaded.light());
  const SampledWavelengths lambda = loaded.lambda();
  const auto at = [&](Vec2 uv) { return light.radiance({{}, {0, 0, 1}, uv}, {0, 0, 1}, lambda); };
  EXPECT_NEAR(relative_to_white(at({0.6f, 0.6f}), lambda), 1, 0.005);
  EXPECT_NEAR(relative_to_white(at({0.05f, 0.05f}), lambda), 1, 0.005);
  EXPECT_GT(at({0.05f, 0.95f})[0], 5 * at({0.05f, 0.95f})[1]);
  // Sampled points have the (u, v) of the place.
  for (int i = 0; i < 100; ++i) {
    const auto s = light.sample({0.3f, 0.4f, 2}, {(float(i) + 0.5f) / 100, 0.37f}, lambda);
    ASSERT_TRUE(s);
    const Vec3 p = Vec3{0.3f, 0.4f, 2} + s->wi * s->distance;
    EXPECT_NEAR(s->radiance[1], at({p.x, p.y})[1], 1e-4f * s->radiance[1] + 1e-9f);
  }
}

TEST(ImageAreaLight, GivesOffThePowerThatIsAskedFor) {
  const TestFolder folder("lights");
  write_image(folder.name_of("a.exr"), even(4, 4, 0.25f), {"linear sRGB", {}});
  const Loaded loaded(
      fmt::format("WorldBegin AreaLightSource \"diffuse\" \"string filename\" \"{}\" \"float power\" 3 Shape \"disk\"",
                  folder.name_of("a.exr")));
  const auto& light = dynamic_cast<const AreaLight&>(loaded.light());
  EXPECT_NEAR(light.power(1), 3, 1e-5);
  EXPECT_NEAR(
      relative_to_white(light.radiance({{}, {0, 0, 1}, {0.5f, 0.5f}}, {0, 0, 1}, loaded.lambda()), loaded.lambda()),
      3 / (kPiD * kPiD), 0.002);
}

/// Reading warns once for each image with values that are not light.
TEST(ImageAreaLight, ReadsItsImageOnceForAllItsShapes) {
  const TestFolder folder("lights");
  Image image = even(4, 4, 1);
  image.at(2, 2, 1) = -0.5f;
  write_image(folder.name_of("a.exr"), image, {"linear sRGB", {}});
  const Loaded loaded(fmt::format(
      "WorldBegin AreaLightSource \"diffuse\" \"string filename\" \"{}\" \"float power\" 2 {} Shape \"disk\"",
      folder.name_of("a.exr"), kSquare));
  EXPECT_EQ(loaded.scene->lights().size(), 3u);
  EXPECT_EQ(std::ranges::count_if(loaded.warnings, [](const std::string& w) { return w.find("down to") != w.npos; }),
            1);
  for (const Light* light : loaded.scene->lights()) EXPECT_NEAR(light->power(1), 2, 1e-5);
}

TEST(LightImages, AreNotNegative) {
  const TestFolder folder("lights");
  Image image = even(4, 4, 1);
  image.at(2, 2, 1) = -0.5f;
  write_image(folder.name_of("a.exr"), image, {"linear sRGB", {}});
  const Loaded sky = with_light(fmt::format("\"infinite\" \"string filename\" \"{}\"", folder.name_of("a.exr")));
  EXPECT_THAT(sky.warnings, Contains(HasSubstr("down to -0.5")));
}

/// With more than some thousands of colours, reflectances are interpolated.
TEST(LightImages, HaveTheirColorsHoweverMany) {
  constexpr int kSize = 160;
  Image image(kSize, kSize, {"R", "G", "B"});
  RandomStream random(1);
  for (float& v : image.pixels) v = std::pow(random.uniform(), 3.f) * 7;
  const ColorSpace& space = *find_color_space("srgb");
  const LightImage light({image, &space});
  double largest = 0;
  for (int i = kSize * (kSize - 4); i < kSize * kSize; i += 3) {
    const Vec2 uv{(float(i % kSize) + 0.5f) / kSize, (float(i / kSize) + 0.5f) / kSize};
    Triple xyz{};
    for (int nm = 360; nm <= 830; nm += kLanes) {
      SampledWavelengths lambda;
      lambda.count = kLanes;
      for (int lane = 0; lane < kLanes; ++lane) lambda.nm[size_t(lane)] = float(std::min(nm + lane, 830));
      const SampledSpectrum s = light.nearest(uv, lambda);
      for (int lane = 0; lane < kLanes && nm + lane <= 830; ++lane)
        for (size_t c = 0; c < 3; ++c) xyz[c] += cie_xyz(nm + lane)[c] * double(s[lane]);
    }
    const Triple rgb = space.rgb_from_xyz * xyz;
    const float* const wanted = &image.at(i % kSize, i / kSize, 0);
    const double peak = double(std::max({wanted[0], wanted[1], wanted[2]}));
    for (size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(rgb[c] - double(wanted[c])) / peak);
  }
  EXPECT_LT(largest, 1e-3);
}

TEST(Cameras, SphericalOnesHaveYAtTheTop) {
  const Loaded equirect(
      "Camera \"spherical\" \"string mapping\" \"equirectangular\" Film \"rgb\" \"integer xresolution\" 80 "
      "\"integer yresolution\" 40 WorldBegin LightSource \"infinite\""),
      equal(
          "Camera \"spherical\" Film \"rgb\" \"integer xresolution\" 40 \"integer yresolution\" 40 WorldBegin "
          "LightSource \"infinite\"");
  const auto expect = [](const Loaded& loaded, Vec2 film, const Vec3& d) {
    const Ray ray = loaded.scene->camera().ray(film, {});
    EXPECT_LT(length(ray.d - d), 1e-5) << film.x << ' ' << film.y;
  };
  expect(equirect, {0, 20}, {1, 0, 0});
  expect(equirect, {20, 20}, {0, 0, 1});
  expect(equirect, {40, 20}, {-1, 0, 0});
  expect(equirect, {40, 0}, {0, 1, 0});
  expect(equal, {20, 20}, {0, 1, 0});
  expect(equal, {0, 0}, {0, -1, 0});
  expect(equal, {40, 20}, {1, 0, 0});
  expect(equal, {20, 40}, {0, 0, 1});
}

/// Rays of several points equal the rays of each point to the bit; 7 is no multiple of the number that is computed at
/// once.
TEST(Cameras, RaysOfSeveralPointsAreThoseOfEach) {
  for (const std::string camera :
       {"LookAt 1 2 3 0 0.5 0 0 0 1 Camera \"perspective\"",
        "LookAt 1 2 3 0 0.5 0 0 0 1 Camera \"perspective\" \"float lensradius\" .1 \"float focaldistance\" 3",
        "Scale 1e18 1e18 1e18 Camera \"perspective\"", "Camera \"orthographic\"", "Camera \"spherical\""}) {
    const Loaded loaded(camera + " WorldBegin LightSource \"infinite\"");
    RandomStream random(3);
    std::array<Vec2, 7> film, lens;
    for (Vec2& p : film) p = {1280 * random.uniform(), 720 * random.uniform()};
    for (Vec2& p : lens) p = {random.uniform(), random.uniform()};
    std::array<Ray, 7> rays;
    loaded.scene->camera().rays(film.data(), lens.data(), int(rays.size()), rays.data());
    for (size_t i = 0; i < rays.size(); ++i) {
      const Ray ray = loaded.scene->camera().ray(film[i], lens[i]);
      EXPECT_TRUE(rays[i].o == ray.o && rays[i].d == ray.d && rays[i].t_max == ray.t_max) << camera << ' ' << i;
    }
  }
}

TEST(Films, ACropBeyondTheFilmIsClamped) {
  const FilmSettings film =
      Loaded(
          "Film \"rgb\" \"integer xresolution\" 40 \"integer yresolution\" 20 \"float cropwindow\" [0.5 1.5 -1 1e30] "
          "\"string filename\" \"a/b.pfm\" WorldBegin LightSource \"infinite\"")
          .scene->film();
  EXPECT_EQ(film.crop.x0, 20);
  EXPECT_EQ(film.crop.x1, 40);
  EXPECT_EQ(film.crop.y0, 0);
  EXPECT_EQ(film.crop.y1, 20);
  EXPECT_EQ(film.filename, "a/b.exr");  // with a warning: pbrt-v4 writes PFM too
}

TEST(Cameras, OpenTimeIsAFactorOfTheFilm) {
  const auto exposure = [](const std::string& camera, const std::string& film) {
    return Loaded(camera + " Film \"rgb\" " + film + " WorldBegin LightSource \"infinite\"").scene->film().exposure;
  };
  EXPECT_EQ(exposure("", ""), 1);
  EXPECT_NEAR(
      exposure("Camera \"perspective\" \"float shutteropen\" .2 \"float shutterclose\" .7", "\"float iso\" 250"), 1.25,
      1e-6);
  EXPECT_NEAR(exposure("Camera \"orthographic\" \"float shutteropen\" 3", ""), 2, 1e-6) << "exchanged";
  EXPECT_THAT(error_of([] { Loaded("Camera \"realistic\" WorldBegin"); }), HasSubstr("\"realistic\""));
}

TEST(Cameras, AShortOpenTimeIsWarnedOfOnceUnlessTheFilmStatesItsExposure) {
  const auto warnings = [](const std::string& camera, const std::string& film) {
    const Loaded loaded("Camera \"perspective\" " + camera + " Film \"rgb\" " + film +
                        " WorldBegin LightSource \"infinite\"");
    return loaded.warnings;
  };
  const std::string short_time = "\"float shutteropen\" 0 \"float shutterclose\" 0.02";
  EXPECT_THAT(warnings(short_time, ""),
              ElementsAre(AllOf(HasSubstr("the shutter is open for 0.02 s"), HasSubstr("is 0.02"),
                                HasSubstr("50 times darker"), HasSubstr("\"float iso\" 5000"))));
  EXPECT_THAT(warnings("\"float shutterclose\" 10", ""),
              ElementsAre(AllOf(HasSubstr("10 times brighter"), HasSubstr("\"float iso\" 10 "))));
  EXPECT_THAT(warnings(short_time, "\"float iso\" 100"), IsEmpty());
  EXPECT_THAT(warnings(short_time, "\"float iso\" 5000"), IsEmpty());
  EXPECT_THAT(warnings(short_time, "\"float exposuretime\" 50"), IsEmpty());
  EXPECT_THAT(warnings("\"float shutteropen\" .5", ""), IsEmpty());
  EXPECT_THAT(warnings("", ""), IsEmpty());
}

TEST(Spectra, OfTablesThatEndWithinTheVisibleAreZeroBeyond) {
  const Loaded lamp("WorldBegin LightSource \"infinite\" \"spectrum L\" [450 1 620 1]", "hero");
  const Spectrum& emission = lamp.light().emission();
  EXPECT_EQ(emission.at(449), 0);
  EXPECT_EQ(emission.at(621), 0);
  EXPECT_GT(emission.at(450), 0);
  EXPECT_NEAR(photometric(emission), 1, 1e-3);
  EXPECT_THAT(lamp.warnings, Contains(HasSubstr("0 beyond")));
  EXPECT_TRUE(with_light("\"infinite\" \"spectrum L\" [400 1 700 1]").warnings.empty()) << "all that is asked for";
  EXPECT_THAT(error_of([] {
                Loaded("WorldBegin LightSource \"infinite\" \"spectrum L\" [450 1 620 1]",
                       "bands,lambdamin=400,lambdamax=1000");
              }),
              HasSubstr("the render needs 400 to 1000 nm"));
}

TEST(Spectra, OfBlackbodiesTakeTheTemperatureAlone) {
  const Loaded old = with_light("\"infinite\" \"blackbody L\" [4000 7]"),
               plain = with_light("\"infinite\" \"blackbody L\" 4000");
  EXPECT_EQ(old.light().emission().at(600), plain.light().emission().at(600));
  EXPECT_THAT(old.warnings, Contains(HasSubstr("one value")));
  EXPECT_TRUE(plain.warnings.empty());
}

/// The colour space of its directive defines the meaning of an rgb value.
TEST(ColorSpaces, HoldToTheEndOfTheirBlock) {
  const auto luminance = [](const std::string& before, const std::string& light) {
    return photometric(
        Loaded(before + " LightSource \"infinite\" \"rgb L\" [0 1 0] " + light, "hero").light().emission());
  };
  const double srgb = luminance("WorldBegin", ""), rec2020 = luminance("WorldBegin ColorSpace \"rec2020\"", "");
  EXPECT_NEAR(srgb, 0.7152, 2e-3);
  EXPECT_NEAR(rec2020, 0.678, 6e-3) << "as near as a smooth light comes";
  EXPECT_EQ(luminance("ColorSpace \"rec2020\" WorldBegin", ""), rec2020);
  EXPECT_EQ(luminance("WorldBegin AttributeBegin ColorSpace \"rec2020\" AttributeEnd", ""), srgb);
  EXPECT_EQ(luminance("Film \"rgb\" ColorSpace \"rec2020\" WorldBegin", ""), rec2020);
  EXPECT_EQ(parse_scene_text("Film \"rgb\" ColorSpace \"rec2020\" WorldBegin", "t", silent_log()).color_space, "srgb");
  EXPECT_EQ(parse_scene_text("ColorSpace \"rec2020\" Film \"rgb\" WorldBegin", "t", silent_log()).color_space,
            "rec2020");
  EXPECT_EQ(error_of([] { parse_scene_text("ColorSpace \"rec202\" WorldBegin", "t", silent_log()); }).substr(0, 7),
            "t:1:12:");
}

}  // namespace
}  // namespace frond
