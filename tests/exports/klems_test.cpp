#include "exports/klems.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/exports/planted.h"

namespace frond {
namespace {

/// Mean of cos theta over a patch by projected solid angle.
double mean_cosine(size_t patch) {
  size_t left = patch;
  auto ring = KlemsBasis::kRings.begin();
  for (; left >= size_t(ring->phis); ++ring) left -= size_t(ring->phis);
  const double a = std::cos(ring->theta_min_deg * std::numbers::pi / 180);
  const double b = ring->theta_max_deg == 90 ? 0 : std::cos(ring->theta_max_deg * std::numbers::pi / 180);
  return 2.0 / 3 * (a * a * a - b * b * b) / (a * a - b * b);
}

TEST(KlemsBasis, PatchesCoverTheHemisphereOnce) {
  double sum = 0;
  int patches = 0;
  for (const auto& ring : KlemsBasis::kRings) patches += ring.phis;
  EXPECT_EQ(patches, int(KlemsBasis::kPatches));
  for (size_t p = 0; p < KlemsBasis::kPatches; ++p) sum += KlemsBasis::projected_solid_angle(p);
  EXPECT_NEAR(sum, std::numbers::pi, 1e-12);
}

TEST(KlemsBasis, NodesFindMeansOverTheirPatch) {
  for (const int order : {2, 3, 5})
    for (const size_t patch : {0ul, 1ul, 60ul, 144ul}) {
      double weight = 0, cosine = 0;
      for (const auto& node : KlemsBasis::nodes(patch, order)) {
        weight += node.weight;
        cosine += node.weight * double(node.w.z);
        EXPECT_GT(node.w.z, 0);
      }
      EXPECT_NEAR(weight, 1, 1e-12);
      EXPECT_NEAR(cosine, mean_cosine(patch), 1e-6);
    }
}

// f = (2 + light.z) (3 + seen.z) + light.x, which distinguishes sides and directions.
TEST(KlemsMatrices, HoldMeansOfEachPairOnEachSide) {
  const Planted planted([](const Vec3& seen, const Vec3& light) { return (2 + light.z) * (3 + seen.z) + light.x; });
  const KlemsMatrices m(planted.exported(), {500});
  EXPECT_LT(m.error(), std::numbers::pi * 12 * 2e-4 + 2e-5);  // f is 12 at most
  EXPECT_EQ(m.unconverged(), 0u);
  for (const size_t in : {0ul, 1ul, 9ul, 77ul, 144ul})
    for (const size_t out : {0ul, 40ul, 133ul})
      for (const bool front : {true, false})
        for (const bool reflected : {true, false}) {
          double x = 0;  // of the light: it comes from the other side of the axis than the patch's own direction
          for (const auto& node : KlemsBasis::nodes(in, 12)) x -= node.weight * double(node.w.x);
          const double i = front ? mean_cosine(in) : -mean_cosine(in);
          const double o = front == reflected ? mean_cosine(out) : -mean_cosine(out);
          EXPECT_NEAR(m.f(0, front ? LitSide::front : LitSide::back, reflected, in, out), (2 + i) * (3 + o) + x, 3e-4)
              << in << " " << out;
        }
}

TEST(KlemsMatrices, SayWhereALobeIsTooNarrow) {
  const Planted planted([](const Vec3& seen, const Vec3& light) {
    const float across = std::hypot(seen.x + light.x, seen.y + light.y);
    return seen.z * light.z > 0 ? 100 * std::exp(-1e6f * across * across) : 0;
  });
  const KlemsMatrices m(planted.exported(), {500});
  EXPECT_GT(m.unconverged(), 100u);
  EXPECT_GT(m.error(), 1e-3);
}

TEST(ExportedBsdf, RefusesWhatNoTableCanHold) {
  const auto with = [](Lobes flags, float index) {
    const Planted planted([](const Vec3&, const Vec3&) { return 1.f; }, flags, index);
    return error_of([&] { ExportedBsdf(planted.exported(), {500}); });
  };
  EXPECT_EQ(with(Lobes::reflection, 1), "");
  EXPECT_THAT(with(Lobes::stochastic, 1), ::testing::HasSubstr("planted: its f is a random estimate"));
  EXPECT_THAT(with(Lobes::specular, 1), ::testing::HasSubstr("planted: it has a delta lobe"));
  EXPECT_THAT(with(Lobes::reflection, 1.5f), ::testing::HasSubstr("planted: it refracts light"));
}

}  // namespace
}  // namespace frond
