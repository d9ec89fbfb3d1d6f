#include "instruments/cubature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "instruments/errors/statistics.h"

namespace frond {
namespace {

/// cos^1000 about a direction, normalised; with a little of something even.
struct NarrowLobe {
  Vec3 axis;
  double share = 1;

  double operator()(const Vec3& w) const {
    const double cos_alpha = static_cast<double>(dot(w, axis)) / static_cast<double>(length(w));
    return share * 1001 / (2 * std::numbers::pi) * std::pow(std::max(0.0, cos_alpha), 1000.0) +
           (1 - share) / (4 * std::numbers::pi);
  }
  std::vector<Vec3> sample(int count, uint64_t seed) const {
    const Frame frame = Frame::around(axis);
    RandomStream numbers(seed);
    std::vector<Vec3> result;
    for (int i = 0; i < count; ++i)
      result.push_back(frame.to_world(
          sphere_direction(std::pow(numbers.uniform_double(), 1 / 1001.0), 2 * std::numbers::pi * numbers.uniform())));
    return result;
  }
};

TEST(Integrate, SolidAngleOfTheSphere) {
  EXPECT_NEAR(total(integrate(
                  {}, [](const Vec3&) { return 1; }, 1e-9)),
              4 * std::numbers::pi, 1e-12);
}

TEST(Integrate, PartOfACosineLobe) {
  // cos theta / pi over cos theta in [a, b), phi in [0, 1): (b^2 - a^2) / (2 pi).
  const SphereBox box{0.2, 0.9, 0, 1};
  const auto lobe = [](const Vec3& w) { return static_cast<double>(w.z) / std::numbers::pi; };
  EXPECT_NEAR(total(integrate(box, lobe, 1e-9)), (0.81 - 0.04) / (2 * std::numbers::pi), 1e-8);
}

TEST(Integrate, NarrowLobeInSmallShareIsFoundFromItsPeaks) {
  for (const double cos_theta : {1.0, 0.7, 0.1})
    for (uint64_t seed = 0; seed < 5; ++seed) {
      const NarrowLobe lobe{sphere_direction(cos_theta, 1.2), 0.04};
      const SphereBins bins(lobe.sample(40, seed), 8);
      double sum = 0;
      for (size_t b = 0; b < bins.size(); ++b) sum += total(integrate(bins.box(b), lobe, 1e-8, bins.points(b)));
      EXPECT_NEAR(sum, 1, 1e-4) << cos_theta << ", seed " << seed;
    }
}

TEST(PartSampler, MeanOfQuotientsIsTheIntegral) {
  const NarrowLobe lobe{sphere_direction(0.6, 1), 0.5};
  const SphereBox box{0, 1, 0, 2};  // most of the lobe, a sixth of what is even
  const std::vector<SpherePoint> peaks{SpherePoint(lobe.axis)};
  const PartSampler sampler(integrate(box, lobe, 1e-8, peaks));
  RandomStream numbers(3);
  Moments lobe_quotients, area_quotients;
  for (int i = 0; i < 20000; ++i) {
    const auto [w, density] = sampler.draw(numbers);
    lobe_quotients.add(lobe(w) / density);
    area_quotients.add(1 / density);
  }
  // A new seed fails each of these once in 10^6 times.
  EXPECT_GT(equality_p(lobe_quotients.estimate(), {.mean = 0.5 + 0.5 * 2 / (4 * std::numbers::pi)}, 1e-4), 1e-6);
  EXPECT_GT(equality_p(area_quotients.estimate(), {.mean = 2}, 0), 1e-6);
  EXPECT_LT(lobe_quotients.variance(), 2) << "draws follow the lobe";
}

}  // namespace
}  // namespace frond
