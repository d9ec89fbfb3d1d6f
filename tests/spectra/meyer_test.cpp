#include <gmock/gmock.h>

#include <cmath>

#include "spectra/cie.h"
#include "spectra/color/color_space.h"
#include "spectra/tabulated.h"
#include "spectra/wavelengths/registry.h"
#include "tests/support/bind.h"

namespace frond {
namespace {

std::unique_ptr<WavelengthStrategy> make_meyer(const std::string& white) {
  const WavelengthsInfo& info = PluginTable<WavelengthsInfo>("wavelengths", builtin_wavelengths()).get("meyer", {});
  return test::make_plugin(info, {{"string", "white", {}, {}, std::vector<std::string>{white}}});
}

/// His matrix from XYZ to the opponent space.
constexpr Matrix3 kOpponent{{{{-0.0177, 1.0090, 0.0073}, {-1.5370, 1.0821, 0.3209}, {0.1946, -0.2045, 0.5264}}}};

/// Opponent response to one unit of radiance in a lane.
Triple response(const WavelengthStrategy& meyer, int lane) {
  const SampledWavelengths lambda = meyer.sample(0.5f);
  SampledSpectrum unit;
  unit[lane] = 1;
  return kOpponent * meyer.sensor(unit, lambda).color();
}

// Numbers as quoted from the paper, whose weights are per 101 nm. Its sums were coarser than these integrals: by steps
// of 5 nm the points are 490.87 and 631.45 nm.
TEST(Meyer, FindsThePublishedWavelengthsAndWeights) {
  const auto meyer = make_meyer("published");
  const SampledWavelengths lambda = meyer->sample(0.1f);
  constexpr std::array<double, 4> kPublished_nm{456.4, 490.9, 557.7, 631.4};
  constexpr std::array<Triple, 4> kPublished{
      {{0, 0, 0.54640}, {0.18892, 0.31824, 0}, {0.67493, 0, 0}, {0.19253, -0.46008, 0}}};
  ASSERT_EQ(lambda.count, 4);
  for (int lane = 0; lane < 4; ++lane) {
    const auto i = static_cast<size_t>(lane);
    EXPECT_NEAR(double(lambda.nm[i]), kPublished_nm[i], 0.2);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(response(*meyer, lane)[c] / 101, kPublished[i][c], 1e-3) << lane << c;
  }
}

/// A polynomial radiance, negative in part: the response is linear all the same.
double power(double nm, int degree) { return std::pow((nm - 560) / 100, degree); }

/// Opponent response to that radiance, by the eye's tables.
Triple exact(int degree) {
  Triple xyz{};
  for (double nm = 360.005; nm < 830; nm += 0.01) {
    const Triple bar = cie_xyz(nm);
    for (size_t c = 0; c < 3; ++c) xyz[c] += bar[c] * power(nm, degree) * 0.01;
  }
  return kOpponent * xyz;
}

Triple by_quadrature(const WavelengthStrategy& meyer, int degree) {
  const SampledWavelengths lambda = meyer.sample(0.5f);
  SampledSpectrum radiance;
  for (size_t i = 0; i < 4; ++i) radiance.v[i] = static_cast<float>(power(double(lambda.nm[i]), degree));
  return kOpponent * meyer.sensor(radiance, lambda).color();
}

TEST(Meyer, IntegratesPolynomialsUpToTheDegreeOfEachAxis) {
  const auto meyer = make_meyer("published");
  constexpr std::array<int, 3> kDegree{2, 3, 1};
  constexpr double kRounding = 1e-4;  // of floats, on responses of up to 100
  for (size_t axis = 0; axis < 3; ++axis) {
    for (int degree = 0; degree <= kDegree[axis]; ++degree)
      EXPECT_NEAR(by_quadrature(*meyer, degree)[axis], exact(degree)[axis], kRounding) << axis << " " << degree;
    const int beyond = kDegree[axis] + 1;
    EXPECT_GT(std::abs(by_quadrature(*meyer, beyond)[axis] - exact(beyond)[axis]), 100 * kRounding) << axis;
  }
}

TEST(Meyer, KeepsTheColorOfD65WhereItIsAsked) {
  const Triple white = to_xyz(*unit_d65());
  const auto seen = [](const WavelengthStrategy& meyer) {
    const SampledWavelengths lambda = meyer.sample(0);
    return meyer.sensor(unit_d65()->sample(lambda), lambda).color();
  };
  const Triple kept = seen(*make_meyer("D65")), published = seen(*make_meyer("published"));
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(kept[c], white[c], 1e-12);
  EXPECT_NEAR(published[2] / white[2], 1.1, 0.01);  // as the documentation says
}

TEST(Meyer, IsTheSameForEveryPathAndFeedsXyz) {
  const auto meyer = make_meyer("published");
  EXPECT_EQ(meyer->film_space(), kXyzName);
  EXPECT_THAT(meyer->fixed_nm(), ::testing::ElementsAreArray(meyer->sample(0.9f).nm));
  EXPECT_TRUE(meyer->range_nm().contains(double(meyer->fixed_nm()[2])));
}

}  // namespace
}  // namespace frond
