// Motion between two transforms: compared with closed forms and with scenes at rest.

#include "core/math/motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "core/math/random.h"
#include "tests/support/input_error.h"
#include "tests/support/render_text.h"

namespace frond {
namespace {

using ::testing::HasSubstr;

AffineMap map_of(const Transform& t) { return {t.rows()}; }

Vec3 in_ball(RandomStream& random, float radius) {
  Vec3 p;
  do {
    p = Vec3{random.uniform(), random.uniform(), random.uniform()} * 2.f - Vec3{1, 1, 1};
  } while (dot(p, p) > 1);
  return p * radius;
}

AffineMap random_map(RandomStream& random) {
  const Transform turn = Transform::rotate(360 * double(random.uniform()), in_ball(random, 1));
  const Vec3 by{0.5f + random.uniform(), 0.5f + random.uniform(), 0.5f + random.uniform()};
  const Transform shear = Transform::rotate(50 * double(random.uniform()), in_ball(random, 1));
  return map_of(Transform::translate(in_ball(random, 3)) * turn * Transform::scale(by) * shear);
}

void expect_near(const Vec3& a, const Vec3& b, float within) { EXPECT_LT(length(a - b), within) << a.x << " " << b.x; }

TEST(Motion, BeginsAndEndsWithItsMaps) {
  RandomStream random(1);
  for (int i = 0; i < 200; ++i) {
    AffineMap start = random_map(random), end = random_map(random);
    if (i % 4 == 0)  // both mirror
      for (size_t k = 0; k < 3; ++k) start.rows[k][0] *= -1, end.rows[k][0] *= -1;
    EXPECT_EQ(problem_of_motion(start, end), "");
    const Motion motion(start, end, {0, 1});
    const Vec3 p = in_ball(random, 1);
    expect_near(motion.at(0).point(p), start.point(p), 1e-5f);
    expect_near(motion.at(1).point(p), end.point(p), 1e-5f);
    // It is held before and after; a shutter sees its share.
    expect_near(Motion(start, end, {-1, 3}).at(0.1f).point(p), start.point(p), 1e-5f);
    expect_near(Motion(start, end, {-1, 3}).at(0.9f).point(p), end.point(p), 1e-5f);
    expect_near(Motion(start, end, {0.2, 0.6}).at(0.5f).point(p), motion.at(0.4f).point(p), 1e-5f);
  }
}

TEST(Motion, InterpolatesTranslationRotationAndScaleApart) {
  // A rotation, then an offset: the centre takes the chord, the rotation is even.
  const AffineMap start = map_of(Transform::translate({1, 0, 0}));
  const AffineMap end =
      map_of(Transform::rotate(90, {0, 0, 1}) * Transform::translate({1, 0, 0}) * Transform::scale({3, 1, 1}));
  const AffineMap half = Motion(start, end, {0, 1}).at(0.5f);
  expect_near(half.translation(), {0.5f, 0.5f, 0}, 1e-6f);
  expect_near(half.vector({1, 0, 0}), Vec3{1, 1, 0} * std::sqrt(2.f), 1e-6f);  // 45 degrees, scaled by 2
  // 200 degrees are 160 the other way.
  const Motion far(map_of({}), map_of(Transform::rotate(200, {0, 0, 1})), {0, 1});
  expect_near(far.at(0.5f).vector({1, 0, 0}), map_of(Transform::rotate(-80, {0, 0, 1})).vector({1, 0, 0}), 1e-6f);
  EXPECT_THAT(problem_of_motion(map_of({}), map_of(Transform::scale({-1, 1, 1}))), HasSubstr("mirror image"));
}

TEST(Motion, StaysNearItsChords) {
  RandomStream random(2);
  float largest_share = 0;
  for (int i = 0; i < 300; ++i) {
    const double begin = i % 3 == 0 ? -0.3 : 0.1;
    const Motion motion(random_map(random), random_map(random), {begin, 0.8});
    const unsigned parts = motion.parts();
    const float bound = motion.deviation(parts, 2);
    float largest = 0;
    for (int k = 0; k < 20; ++k) {
      const Vec3 p = in_ball(random, 1) * 2.f;
      for (unsigned part = 0; part < parts; ++part) {
        const auto at = [&](float t) { return motion.at((float(part) + t) / float(parts)).point(p); };
        const Vec3 a = at(0), b = at(1);
        for (const float t : {0.1f, 0.25f, 0.4f, 0.5f, 0.6f, 0.75f, 0.9f})
          largest = std::max(largest, length(at(t) - (a * (1 - t) + b * t)));
      }
    }
    EXPECT_LE(largest, bound + 1e-5f);
    if (begin > 0) largest_share = std::max(largest_share, largest / bound);
  }
  EXPECT_GT(largest_share, 0.3f);  // the bound is not empty talk
  const Motion straight(map_of({}), map_of(Transform::translate({5, 6, 7})), {0, 1});
  EXPECT_EQ(straight.parts(), 1u);
  EXPECT_EQ(straight.deviation(1, 10), 0);
}

constexpr int kPixels = 8;

/// Something black before an even sky, seen in parallel from z = 0: x and y from -1 to 1.
std::string shadow_play(const std::string& before, const std::string& camera, const std::string& world) {
  return before + " Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1] " + camera +
         " Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8 PixelFilter \"box\" WorldBegin "
         "LightSource \"infinite\" Material \"diffuse\" \"rgb reflectance\" [0 0 0] Translate 0 0 1 " +
         world;
}

/// Compares each pixel with the mean of `sees_sky(x, y, time)`, from 0 to
/// 1, over the pixel and the exposure of `exposure` s. The deviations over the standard errors are below 5 in 64 pixels
/// with probability 1 - 4e-5.
template <class SeesSky>
void expect_image(const std::string& text, double exposure, const SeesSky& sees_sky) {
  const Film film = test::render_text(text, {.samples = 1024});
  const double sky = test::render_text(shadow_play("", "", "")).mean(0, 0)[1];
  for (int j = 0; j < kPixels; ++j)
    for (int i = 0; i < kPixels; ++i) {
      constexpr int kPoints = 16, kTimes = 400;
      double sum = 0;
      for (int n = 0; n < kPoints * kPoints * kTimes; ++n) {
        const double x = -1 + 2 * (i + (n % kPoints + 0.5) / kPoints) / kPixels;
        const double y = 1 - 2 * (j + (n / kPoints % kPoints + 0.5) / kPoints) / kPixels;
        sum += sees_sky(x, y, (n / kPoints / kPoints + 0.5) / kTimes);
      }
      const double expected = sky * exposure * sum / (kPoints * kPoints * kTimes);
      const double error = std::sqrt(film.variance(i, j)[1]) + 0.001 * sky;  // and of the sum
      EXPECT_NEAR(film.mean(i, j)[1], expected, 5 * error) << i << " " << j;
    }
}

constexpr const char* kSquare =
    "Shape \"trianglemesh\" \"point3 P\" [-.25 -.25 0 .25 -.25 0 .25 .25 0 -.25 .25 0] "
    "\"integer indices\" [0 1 2 0 2 3] ";

double is_outside_square(double x, double y) { return std::abs(x) > 0.25 || std::abs(y) > 0.25; }

// A square goes from x = -.75 to 1; the shutter opens after a quarter of the way.
TEST(Motion, OfAShapeIsSeenThroughTheShutter) {
  const std::string moving =
      std::string("Translate -.75 .1 0 ActiveTransform EndTime Translate 1.75 0 0 ") + "ActiveTransform All ";
  const auto sees = [](double x, double y, double t) {
    return is_outside_square(x + 0.75 - 1.75 * (0.25 + 0.75 * t), y - 0.1);
  };
  const std::string shutter = "\"float shutteropen\" .25 \"float shutterclose\" 1";
  expect_image(shadow_play("", shutter, moving + kSquare), 0.75, sees);
  const std::string object = std::string("ObjectBegin \"o\" Translate 0 0 -1 ") + kSquare + "ObjectEnd ";
  expect_image(shadow_play("", shutter, object + moving + "ObjectInstance \"o\""), 0.75, sees);
  // The motion takes from 1 s to 3 s, the exposure from 1.5 s to 3 s.
  expect_image(shadow_play("TransformTimes 1 3", "\"float shutteropen\" 1.5 \"float shutterclose\" 3",
                           object + moving + "ObjectInstance \"o\""),
               1.5, sees);
  // A moving shape in a moving instance: half of the way each.
  const std::string half = "ActiveTransform EndTime Translate .875 0 0 ActiveTransform All ";
  expect_image(shadow_play("", shutter,
                           "ObjectBegin \"o\" Translate 0 0 -1 " + half + kSquare + "ObjectEnd Translate -.75 .1 0 " +
                               half + "ObjectInstance \"o\""),
               0.75, sees);
}

// A wide rectangle turns about its edge by 90 degrees.
TEST(Motion, OfARotationIsEven) {
  const std::string moving = "ActiveTransform EndTime Rotate 90 0 0 1 ActiveTransform All ";
  const std::string half_plane =
      "Shape \"trianglemesh\" \"point3 P\" [-3 0 0 3 0 0 3 3 0 -3 3 0] \"integer indices\" [0 1 2 0 2 3] ";
  expect_image(shadow_play("", "", moving + half_plane), 1, [](double x, double y, double t) {
    const double angle = t * std::numbers::pi / 2;
    return y * std::cos(angle) - x * std::sin(angle) < 0;
  });
}

// The camera's transform is from the world: as if the world moved.
TEST(Motion, OfTheCameraIsThatOfTheWorldAgainstIt) {
  expect_image(
      shadow_play("Translate -.75 .1 0 ActiveTransform EndTime Translate 1.75 0 0 ActiveTransform All", "", kSquare), 1,
      [](double x, double y, double t) { return is_outside_square(x + 0.75 - 1.75 * t, y - 0.1); });
}

std::unique_ptr<Scene> scene(const std::string& world, ThreadPool& pool) {
  const Registry registry = make_registry(builtin_materials(), builtin_integrators());
  const std::string text = "WorldBegin LightSource \"infinite\"\n" + world;
  SceneDescription description = parse_scene_text(text, "test.pbrt", silent_log());
  apply_overrides({.wavelengths = "smpte"}, description, registry, silent_log());
  return std::make_unique<Scene>(description, registry, pool, silent_log());
}

// Packets, in which each ray has its own time, have the same hits as single rays; at the start and at the end these
// equal the hits in scenes without motion.
TEST(Motion, IsTheSameForPacketsAndAtItsEndsForStillScenes) {
  ThreadPool pool(2);
  const std::string end = "Translate .4 .3 -.2 Rotate 140 1 2 3 Scale 1.2 .7 1 ";
  const std::string objects =
      "ObjectBegin \"o\" Shape \"sphere\" \"float radius\" .5 Translate .6 0 0 Shape \"disk\" \"float radius\" .4\n" +
      std::string(kSquare) + "ObjectEnd\n";
  const auto world = [&](const std::string& move) {
    const std::string turned =
        move.empty() ? "" : move + "Rotate 60 0 1 0 " + (move == " " ? "" : "ActiveTransform All ");
    return objects + "ObjectBegin \"p\" ObjectInstance \"o\" Translate 0 1.5 0 " + turned + "ObjectInstance \"o\" " +
           "ObjectEnd AttributeBegin " +
           (move.empty() ? "" : move + end + (move == " " ? "" : "ActiveTransform All ")) +
           "ObjectInstance \"p\" AttributeEnd Translate -1 0 0 ObjectInstance \"p\"";
  };
  const auto moving = scene(world("ActiveTransform EndTime "), pool), still = scene(world(""), pool),
             ended = scene(world(" "), pool);
  EXPECT_TRUE(moving->has_motion());
  EXPECT_FALSE(still->has_motion());
  RandomStream random(3);
  int hits = 0, differ = 0;
  for (int i = 0; i < 20000; ++i) {
    std::array<Ray, RayPacket::kWidth> rays;
    std::array<uint64_t, RayPacket::kWidth> keys{};
    for (Ray& ray : rays) {
      const Vec3 from = in_ball(random, 4), to = in_ball(random, 1.5f);
      ray = {from, normalize(to - from), INFINITY, random.uniform()};
    }
    rays[0].time = 0, rays[1].time = 1;
    std::array<SurfacePoint, RayPacket::kWidth> points;
    const uint32_t met = moving->intersect({rays.data(), keys.data(), 0xff}, points.data());
    EXPECT_EQ(moving->World::occluded({rays.data(), keys.data(), 0xff}),
              moving->occluded({rays.data(), keys.data(), 0xff}));
    for (size_t k = 0; k < RayPacket::kWidth; ++k) {
      SurfacePoint single;
      const bool is_met = moving->intersect(rays[k], 0, single);
      const auto compare = [&](bool other, const SurfacePoint& point) {
        const bool same = is_met == other && (!is_met || length(single.hit.p - point.hit.p) < 1e-4f);
        differ += !same;
      };
      compare(met >> k & 1, points[k]);
      hits += is_met;
      if (k > 1) continue;
      SurfacePoint there;
      const bool is_there = (k == 0 ? still : ended)->intersect(rays[k], 0, there);
      compare(is_there, there);
      if (!is_met) continue;
      EXPECT_LT(std::abs(dot(single.hit.ng, there.hit.ng) - 1), differ == 0 ? 1e-3f : 3.f);
      EXPECT_LT(length(single.hit.p - (rays[k].o + rays[k].d * dot(single.hit.p - rays[k].o, rays[k].d))), 1e-4f);
    }
  }
  EXPECT_GT(hits, 20000);
  EXPECT_LT(differ, 10);  // at the edges
}

TEST(Motion, IsRefusedWhereItIsNotPossible) {
  ThreadPool pool(1);
  const auto refusal = [&pool](const std::string& world) { return error_of([&] { scene(world, pool); }); };
  const std::string end = "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\n";
  EXPECT_THAT(refusal(end + "AreaLightSource \"diffuse\" Shape \"sphere\""),
              HasSubstr("test.pbrt:3:33: a shape that moves cannot give off light"));
  EXPECT_THAT(refusal("ActiveTransform EndTime Scale -1 1 1 ActiveTransform All\nShape \"sphere\""),
              HasSubstr("test.pbrt:3:7: this instance is not possible: it begins as a mirror image of its end"));
  EXPECT_THAT(error_of([] { parse_scene_text("TransformTimes 1 1 WorldBegin", "s", silent_log()); }),
              HasSubstr("s:1:1: TransformTimes 1 1: the end comes after the start"));
}

}  // namespace
}  // namespace frond
