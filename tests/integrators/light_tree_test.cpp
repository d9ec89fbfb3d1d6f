#include "integrators/light_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/math/random.h"
#include "core/math/sampling.h"
#include "tests/support/render_text.h"

namespace frond {
namespace {

using test::channel_mean;
using test::render_text;

Vec3 direction(RandomStream& random) {
  const float z = 2 * random.uniform() - 1, r = std::sqrt(1 - z * z), phi = 2 * kPi * random.uniform();
  return {r * std::cos(phi), r * std::sin(phi), z};
}
Vec3 within(const Vec3& min, const Vec3& max, RandomStream& random) {
  const Vec3 d = max - min;
  return {min.x + d.x * random.uniform(), min.y + d.y * random.uniform(), min.z + d.z * random.uniform()};
}

/// Bulbs, panels and lamps that face a cone, some of them large, in a box of 10 x 10 x 10.
std::vector<LightTree::Entry> lamps(size_t count, RandomStream& random) {
  std::vector<LightTree::Entry> entries;
  for (size_t i = 0; i < count; ++i) {
    const Vec3 at = within({0, 0, 0}, {10, 10, 10}, random);
    const float size = random.uniform() < 0.5f ? 0 : random.uniform();
    LightBounds bounds{.min = at, .max = at + Vec3{size, size / 2, size / 3}};
    if (i % 3 != 0) {
      bounds.axis = direction(random);
      bounds.cos_spread = i % 3 == 1 ? 1 : random.uniform();
      bounds.two_sided = random.uniform() < 0.3f;
    }
    entries.push_back({uint32_t(i), bounds, double(0.01f + random.uniform())});
  }
  return entries;
}

TEST(LightTree, ProbabilitiesAddUpAndAreThoseOfTheChoice) {
  RandomStream random(1);
  for (const size_t count : {1, 2, 3, 200}) {
    const auto entries = lamps(count, random);
    const LightTree tree(entries);
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = within({-2, -2, -2}, {12, 12, 12}, random), n = direction(random);
      double sum = 0;
      for (const auto& e : entries) sum += double(tree.probability(p, n, e.light));
      constexpr int kSteps = 4000;
      std::vector<std::vector<float>> rests(count);
      int none = 0;
      for (int k = 0; k < kSteps; ++k) {
        float u = (float(k) + 0.5f) / kSteps;
        const auto choice = tree.choose(p, n, u);
        if (!choice) {
          ++none;
          continue;
        }
        EXPECT_EQ(choice->probability, tree.probability(p, n, choice->light));
        rests[choice->light].push_back(u);
      }
      // A cluster may be chosen that turns out to have nothing for the point.
      EXPECT_NEAR(sum, 1 - double(none) / kSteps, 0.02);
      for (const auto& e : entries) {
        const auto& rest = rests[e.light];
        const auto chosen = double(rest.size());
        EXPECT_NEAR(chosen / kSteps, double(tree.probability(p, n, e.light)), 1.5 / kSteps + 1e-5);
        // Evenly spaced numbers leave evenly spaced numbers to each light.
        for (size_t j = 0; j < rest.size(); ++j) EXPECT_NEAR(rest[j], (double(j) + 0.5) / chosen, 1 / chosen);
      }
    }
  }
}

TEST(LightTree, WhateverMayArriveMayBeChosen) {
  RandomStream random(2);
  const auto entries = lamps(300, random);
  const LightTree tree(entries);
  int arrived = 0;
  for (int i = 0; i < 200000; ++i) {
    const auto& e = entries[size_t(random.uniform() * 300)];
    const Vec3 from = within(e.bounds.min, e.bounds.max, random), p = within({-2, -2, -2}, {12, 12, 12}, random);
    Vec3 facing = direction(random);
    if (e.bounds.cos_spread > -1) {
      const float z = e.bounds.cos_spread + (1 - e.bounds.cos_spread) * random.uniform(), r = std::sqrt(1 - z * z);
      const float phi = 2 * kPi * random.uniform();
      facing = Frame::around(e.bounds.axis).to_world({r * std::cos(phi), r * std::sin(phi), z});
    }
    if (e.bounds.two_sided && random.uniform() < 0.5f) facing = -facing;
    if (dot(facing, normalize(p - from)) < 1e-3f) continue;
    ++arrived;
    ASSERT_GT(tree.probability(p, direction(random), e.light), 0) << i;
  }
  EXPECT_GT(arrived, 50000);
}

/// The importance of a lamp close by, which may be covered, can be far above another's.
TEST(LightTree, ADistantLampMayBeChosenBesideACloseOne) {
  const Vec3 close{0, 0, -0.001f}, far{0, 0, 10};
  const LightTree tree({{0, {.min = close, .max = close}, 1e4}, {1, {.min = far, .max = far}, 10}});
  const float probability = tree.probability({}, {0, 0, 1}, 1);
  EXPECT_GE(probability, 0.9e-3f);
  float u = 1 - probability / 2;
  const auto choice = tree.choose({}, {0, 0, 1}, u);
  ASSERT_TRUE(choice);
  EXPECT_EQ(choice->light, 1u);
  EXPECT_EQ(choice->probability, probability);
}

/// 1,000 lamps over a plane, in closed form; selection by contribution has less noise than selection by power.
TEST(LightTree, AThousandLampsAddUpWithLittleNoise) {
  std::string world =
      "Material \"diffuse\" \"spectrum reflectance\" [360 .4 2500 .4]\n"
      "Shape \"trianglemesh\" \"point3 P\" [-9 -9 0  9 -9 0  9 9 0  -9 9 0] \"integer indices\" [0 1 2  0 2 3]\n";
  RandomStream random(3);
  double irradiance = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3d at{16 * random.uniform_double() - 8, 16 * random.uniform_double() - 8, 0.2 + random.uniform_double()};
    const double intensity = random.uniform_double();
    world += fmt::format(
        "LightSource \"point\" \"point3 from\" [{} {} {}] \"spectrum I\" \"stdillum-D65\" \"float scale\" {}\n", at.x,
        at.y, at.z, intensity);
    irradiance += intensity * at.z / std::pow(dot(at, at), 1.5);
  }
  const double expected = 0.4 * irradiance / std::numbers::pi;
  std::array<double, 2> errors{};
  for (const bool tree : {false, true}) {
    const std::string scene = fmt::format(
        "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1e-4 1e-4 -1e-4 1e-4]\n"
        "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nSampler \"independent\"\n"
        "Integrator \"path\" \"integer maxdepth\" 1 \"string lightsampler\" \"{}\"\nWorldBegin\n{}",
        tree ? "bvh" : "power", world);
    const auto [mean, error] = channel_mean(render_text(scene, {.samples = 256}), 1);
    EXPECT_NEAR(mean, expected, 5 * error + 1e-5 * expected);  // a false alarm in 1.7 million
    errors[tree] = error;
  }
  EXPECT_LT(errors[1], errors[0] / 5);
}

}  // namespace
}  // namespace frond
