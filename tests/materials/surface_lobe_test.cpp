#include "materials/lobes/surface_lobe.h"

#include <gtest/gtest.h>

#include "tests/leaf/statistics.h"

namespace frond {
namespace {

/// Means over directions drawn: along the surface, up from it, across, and the cosine to the mirror direction.
struct Means {
  std::array<test::Estimate, 4> of;

  Means(const leaf::Lobe& lobe, const Vec3& wo, int count) {
    const SurfaceLobe surface(&lobe);
    RandomStream rng(1);
    for (int i = 0; i < count; ++i) {
      const float u = rng.uniform();
      const Vec3 wi = surface.sample(wo, {u, rng.uniform()}, rng);
      of[0].add(static_cast<double>(wi.x));
      of[1].add(static_cast<double>(std::abs(wi.z)));
      of[2].add(static_cast<double>(wi.y * wi.y));
      of[3].add(static_cast<double>(dot(wi, Vec3{-wo.x, -wo.y, wo.z})));
      EXPECT_GT(wi.z * wo.z, 0);
      EXPECT_NEAR(dot(wi, wi), 1, 2e-6);
    }
  }
};

// Two methods to sample one density: by two angles, and by rejection.
TEST(SurfaceLobe, AnglesAndTrialsHaveTheSameMeans) {
  constexpr double kExponents[] = {0, 0.4, 1, 5, 10, 100};
  constexpr float kCosines[] = {1, 0.7f, 0.17f, 0.01f, -0.3f};
  const double limit = test::z_limit(static_cast<int>(4 * std::size(kExponents) * std::size(kCosines)));
  for (const double e : kExponents)
    for (const float c : kCosines) {
      const Vec3 wo{std::sqrt(1 - c * c), 0, c};
      const Means angles(leaf::CutLobe(e), wo, 100000), trials(leaf::Lobe(e), wo, 100000);
      for (size_t i = 0; i < 4; ++i) {
        const double error = std::hypot(angles.of[i].standard_error(), trials.of[i].standard_error());
        EXPECT_LT(std::abs(angles.of[i].mean() - trials.of[i].mean()), limit * error) << e << " " << c << " " << i;
      }
    }
}

TEST(SurfaceLobe, ACornerOfTheSquareIsADirectionToo) {
  const leaf::CutLobe lobe(5);
  const SurfaceLobe surface(&lobe);
  RandomStream rng(1);
  for (const float c : {1.f, -1.f, 0.5f, 1e-10f})
    for (const float u : {0.f, 0x1p-30f, 0x1.fffffep-1f})
      for (const float v : {0.f, 0x1p-30f, 0x1.fffffep-1f}) {
        const Vec3 wo{std::sqrt(1 - c * c), 0, c}, wi = surface.sample(wo, {u, v}, rng);
        EXPECT_NEAR(dot(wi, wi), 1, 2e-6) << c << " " << u << " " << v;
        EXPECT_GE(std::abs(wi.z), kLeastCosine);
        EXPECT_GT(surface.pdf(wo, wi), 0) << c << " " << u << " " << v;
      }
}

}  // namespace
}  // namespace frond
