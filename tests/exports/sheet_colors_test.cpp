#include "exports/sheet_colors.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/exports/planted.h"

namespace frond {
namespace {

using ::testing::HasSubstr;
using ::testing::Pointwise;

/// f of a Lambertian sheet whose sides differ.
Planted sheet(float front, float back, float transmitted) {
  return Planted([=](const Vec3& seen, const Vec3& light) {
    const float share = seen.z * light.z < 0 ? transmitted : light.z > 0 ? front : back;
    return share / std::numbers::pi_v<float>;
  });
}

ExportRequest with_wavelengths(std::vector<double> nm) {
  ExportRequest request;
  request.wavelengths_nm = std::move(nm);
  return request;
}

MATCHER_P(IsNear, tolerance, "") { return std::abs(std::get<0>(arg) - std::get<1>(arg)) < tolerance; }

TEST(SheetColors, AGreySheetIsGrey) {
  const Planted planted = sheet(0.2f, 0.4f, 0.3f);
  for (const std::vector<double>& nm : {std::vector<double>{}, {608, 551, 455}, {400, 450, 550, 700}}) {
    const SheetColors colors = sheet_colors(planted.exported(), with_wavelengths(nm), true);
    for (const auto& sides : {colors.near_normal, colors.at_grazing_angle}) {
      EXPECT_THAT(sides[0].reflected, Pointwise(IsNear(1e-5), Triple{0.2, 0.2, 0.2}));
      EXPECT_THAT(sides[1].reflected, Pointwise(IsNear(1e-5), Triple{0.4, 0.4, 0.4}));
      for (const SideColors& side : sides)
        EXPECT_THAT(side.transmitted, Pointwise(IsNear(1e-5), Triple{0.3, 0.3, 0.3}));
    }
  }
}

// White furnace: what would create energy is scaled.
TEST(SheetColors, SumsAreAtMostOne) {
  const SheetColors colors = sheet_colors(sheet(0.9f, 0.5f, 0.6f).exported(), {}, true);
  const auto& [front, back] = colors.near_normal;
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(front.reflected[c], 0.6, 1e-5);
    EXPECT_NEAR(front.transmitted[c], 0.4, 1e-5);
    EXPECT_LE(back.reflected[c] + back.transmitted[c], 1 + 1e-12);
  }
}

// At 550 and 560 nm ybar is 0.995; D65 is 104.0 and 100 (CIE 15).
TEST(SheetColors, WeightsAreThoseOfD65) {
  const auto nm = visible_wavelengths();
  const auto y = d65_weights(1, nm);
  EXPECT_EQ(nm.size(), 41u);
  EXPECT_NEAR(y[17] / y[18], 1.04, 0.01);
  EXPECT_NEAR(std::accumulate(y.begin(), y.end(), 0.0), 1, 1e-12);
}

TEST(SheetColors, RefusesTooFewWavelengths) {
  const auto refusal = [](std::vector<double> nm) {
    return error_of([&] { check_sheet_colors(with_wavelengths(std::move(nm))); });
  };
  EXPECT_THAT(refusal({551}), HasSubstr("three wavelengths"));
  EXPECT_THAT(refusal({400, 500, 450, 600}), HasSubstr("must ascend"));
  EXPECT_EQ(refusal({608, 551, 455}), "");
}

TEST(SharedColors, GiveReflectanceAndTransmittanceBack) {
  const SideColors side{{0.1, 0.2, 0.3}, {0.05, 0.4, 0.01}};
  const SharedColors shared = shared_colors(side, silent_log());
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR((1 - shared.share) * shared.reflected[c], side.reflected[c], 1e-12);
    EXPECT_NEAR(shared.share * shared.transmitted[c], side.transmitted[c], 1e-12);
    EXPECT_LE(std::max(shared.reflected[c], shared.transmitted[c]), 1);
  }
}

TEST(SharedColors, OpaqueAndClearSheets) {
  const SharedColors opaque = shared_colors({{0.1, 0.2, 0.3}, {}}, silent_log());
  EXPECT_EQ(opaque.share, 0);
  EXPECT_EQ(opaque.reflected, (Triple{0.1, 0.2, 0.3}));
  const SharedColors clear = shared_colors({{}, {1, 1, 1}}, silent_log());
  EXPECT_EQ(clear.share, 1);
  EXPECT_EQ(clear.reflected, (Triple{}));
}

// T of red is 0.7: of blue, 0.3 may be reflected.
TEST(SharedColors, LowersWhatNoCommonShareHas) {
  const SharedColors shared = shared_colors({{0.1, 0.2, 0.6}, {0.7, 0.1, 0.1}}, silent_log());
  EXPECT_EQ(shared.reflected[2], 1);
  EXPECT_NEAR(0.3 * shared.reflected[1], 0.2, 1e-12);
}

}  // namespace
}  // namespace frond
