#include "leaf/table/depth_table.h"

#include <gtest/gtest.h>

#include <numbers>

#include "leaf/table/lookup.h"
#include "leaf/tissue/specimens.h"

namespace frond::leaf {
namespace {

/// Steps of leaf_simplified.
constexpr double kStep = 0.1, kIndexStep_nm = 40;

TEST(DepthAxis, FindsEveryDepth) {
  for (const double least : {0.0, 1e-7, 0.01, 3.0}) {
    const DepthAxis axis(least, 3, kStep);
    const std::vector<double>& depths = axis.depths();
    EXPECT_EQ(depths.front() == 0, least < 3e-5);
    EXPECT_NEAR(depths.back(), 3, 1e-12);
    for (double depth = std::max(least, 1e-9); depth <= 3; depth *= 1.37) {
      const auto [below, t] = axis.cell(depth);
      ASSERT_LT(below + 1, depths.size());
      const double a = depths[below], b = depths[below + 1];
      const double expected = a == 0 ? b * double(t) : a * std::pow(b / a, double(t));
      EXPECT_NEAR(depth, expected, 1e-5 * depth) << least;
    }
    EXPECT_EQ(axis.cell(0).t, 0);
    EXPECT_EQ(axis.cell(1e9).below, depths.size() - 2);
    EXPECT_EQ(axis.cell(1e9).t, 1);
  }
  EXPECT_EQ(DepthAxis(2, 2, kStep).cell(2).below, 0u);
  EXPECT_EQ(DepthAxis(0, 0, kStep).cell(0).below, 0u);
}

struct Errors {
  double largest = 0, sum = 0;
  int count = 0;
  void add(const SampledShares& measured, int lane, const Shares& exact) {
    for (const double e :
         {double(measured.surface[lane]) - exact.surface, double(measured.subsurface[lane]) - exact.subsurface,
          double(measured.transmitted[lane]) - exact.transmitted}) {
      largest = std::max(largest, std::abs(e));
      sum += std::abs(e), ++count;
    }
  }
};

/// At random wavelengths, depths (log-uniform, and small ones) and angles, against solutions.
Errors errors_of(const char* specimen, bool sieve, double least, double most, bool varying) {
  TissueParams params = find_specimen(specimen)->params;
  params.sieve_and_detour = sieve;
  const TissueModel model(params);
  const std::vector<double> fixed{455, 551, 800};
  const DepthTable table = make_depth_table(
      model, even_steps(0, params.structure == Structure::unifacial ? 90 : 180, 1),
      varying ? even_steps(360, 840, kIndexStep_nm) : fixed, DepthAxis(least, most, kStep), ThreadPool());
  const TableLookup lookup = varying ? TableLookup::for_spectra(table) : TableLookup::for_lanes(table);
  RandomStream rng(4);
  Errors errors;
  for (int i = 0; i < 150; ++i) {
    const int lane = i % 3;
    const double nm = varying ? 360 + 470 * rng.uniform_double() : fixed[static_cast<size_t>(lane)];
    const double first = std::max(least, most * 1e-7);
    const double depth = first * std::pow(most / first, rng.uniform_double());
    const double theta_deg = i % 2 ? 180 * rng.uniform_double() : 85 + 10 * rng.uniform_double();
    SampledWavelengths lambda;
    lambda.count = 3;
    lambda.nm.fill(static_cast<float>(nm));
    std::array<double, kLanes> depths;
    depths.fill(depth);
    const auto cosine = static_cast<float>(std::cos(theta_deg * std::numbers::pi / 180));
    const Tissue tissue = model.at(nm, depth, model.lobes());
    errors.add(lookup(cosine, lookup.select(lambda, depths)), lane, solve(tissue, std::array{theta_deg})[0]);
  }
  return errors;
}

/// The accuracy that docs/file_formats.md states.
TEST(DepthTable, IsAsExactAsStated) {
  for (const char* specimen : {"soybean", "maize"}) {
    const bool sieve = specimen[0] == 'm';
    const Errors fixed = errors_of(specimen, sieve, 0, 6, false), varying = errors_of(specimen, sieve, 0.03, 6, true);
    EXPECT_LT(fixed.largest, 2e-4) << specimen;
    EXPECT_LT(varying.largest, 4e-4) << specimen;
    EXPECT_LT(std::max(fixed.sum / fixed.count, varying.sum / varying.count), 3e-5) << specimen;
  }
}

}  // namespace
}  // namespace frond::leaf
