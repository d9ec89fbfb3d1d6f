#include "core/fluorescence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <numbers>

#include "instruments/errors/statistics.h"
#include "leaf/fluorescence/emission.h"
#include "leaf/fluorescence/fluorescence_table.h"
#include "leaf/solve/fluorescence_solver.h"
#include "leaf/solve/modes.h"
#include "leaf/solve/quadrature.h"
#include "leaf/solve/solver.h"
#include "leaf/table/mode_table.h"
#include "leaf/tissue/absorption.h"
#include "leaf/tissue/fresnel.h"
#include "leaf/tissue/specimens.h"
#include "tests/leaf/statistics.h"
#include "tests/support/input_error.h"

namespace frond::leaf {
namespace {

using namespace frond::test;
using ::testing::HasSubstr;

Vec3d toward_light(double theta_deg) {
  const double theta = theta_deg * std::numbers::pi / 180;
  return {std::sin(theta), 0, std::cos(theta)};
}

TissueParams leaf_like(std::string_view specimen) { return find_specimen(specimen)->params; }

TEST(Emission, IsADistributionFrom640To850) {
  const SpectrumPoint points[] = {{600, 1}, {700, 3}, {900, 1}};
  for (const EmissionShape& shape : {EmissionShape(), EmissionShape("three points", points, {})}) {
    double sum = 0;
    for (double nm = 640; nm <= 850; ++nm) sum += shape.at(nm);
    EXPECT_NEAR(sum, 1, 1e-12) << shape.name();
    EXPECT_EQ(shape.at(639.9), 0);
    EXPECT_EQ(shape.at(850.1), 0);
    EXPECT_NEAR(shape.at(700.5), (shape.at(700) + shape.at(701)) / 2, 1e-15);
  }
  const EmissionShape published;
  // Each Gaussian has a tail at the other's peak.
  EXPECT_NEAR(published.at(746) / published.at(688), 0.94 / 1.030, 0.002);
  EXPECT_NEAR(published.at(688 - 15) / published.at(688), 0.504 / 1.030, 0.002);
  EXPECT_EQ(EmissionShape("a file", points, {}).name(), "a file");
}

TEST(Emission, MustNotBeZeroWhereItIsUsed) {
  const SpectrumPoint elsewhere[] = {{400, 1}, {500, 1}}, zero[] = {{640, 0}, {850, 0}};
  for (const std::span<const SpectrumPoint> points : {std::span(elsewhere), std::span(zero)})
    EXPECT_THAT(error_of([&] { EmissionShape("a file", points, {}); }),
                HasSubstr("a file: the emission is 0 from 640"));
}

TEST(Emission, HasAGateOfStokes) {
  EXPECT_EQ(stokes_gate(700, 700), 0.5);
  EXPECT_NEAR(stokes_gate(740, 440), 1, 1e-12);
  EXPECT_NEAR(stokes_gate(680, 710), 1 / (1 + std::exp(3)), 1e-15);
  const EmissionShape shape;
  EXPECT_EQ(emitted_density(0, shape, 740, 440), 0);
  EXPECT_DOUBLE_EQ(emitted_density(0.5, shape, 690, 700), 0.5 * shape.at(690) * stokes_gate(690, 700));
}

TEST(Fluorescence, IsExcitedByTheShareOfChlorophyll) {
  TissueParams leaf = leaf_like("soybean");
  EXPECT_GT(fluorescing_share(leaf, 680), 0.95);
  EXPECT_LT(fluorescing_share(leaf, 680), 1);
  EXPECT_LT(fluorescing_share(leaf, 480), fluorescing_share(leaf, 440));  // carotenoids
  TissueParams without = leaf;
  without.number("chlorophylla") = without.number("chlorophyllb") = 0;
  EXPECT_EQ(fluorescing_share(without, 680), 0);
  // Pigments of files count if they fluoresce: twice the share of half the chlorophyll.
  without.pigments = {{1, std::vector<double>(kAbsorptionGrid.size(), 1e5), true},
                      {3, std::vector<double>(kAbsorptionGrid.size(), 1e5), false}};
  EXPECT_NEAR(fluorescing_share(without, 680), 0.25, 0.01);
  TissueParams nothing;
  EXPECT_EQ(fluorescing_share(nothing, 680), 0);
}

/// Absorption, by depth, and light emitted at each depth: photons are conserved, and directions add up to the sides.
TEST(FluorescenceSolver, ConservesPhotons) {
  for (const char* specimen : {"soybean", "maize", "tomato", "grape"}) {
    const TissueModel model(leaf_like(specimen));
    const std::vector<double> sines = grid_sines(12);
    const Tissue excited = model.at(550), emitting = model.at(690);
    const SolvedExcitation excitation = solve_excitation(excited, sines, mode_nodes(excited));
    const SolvedEmission emission = solve_emission(emitting, sines, mode_nodes(emitting));
    const double n = emitting.n_cuticle();
    for (size_t depth = 0; depth < emission.reabsorbed.size(); ++depth) {
      EXPECT_NEAR(emission.left[0][depth] + emission.left[1][depth] + emission.reabsorbed[depth], 1, 1e-10);
      EXPECT_GE(emission.reabsorbed[depth], 0);
    }
    const double theta_deg = std::asin(sines[7]) * 180 / std::numbers::pi;
    for (const bool below : {false, true}) {
      double absorbed = 0;
      for (const double a : excitation.absorbed[below][7]) absorbed += a;
      const Shares shares = solve(excited, std::array{below ? 180 - theta_deg : theta_deg})[0];
      EXPECT_NEAR(absorbed * (1 - shares.surface), 1 - shares.surface - shares.subsurface - shares.transmitted, 2e-5)
          << specimen;
    }
    // At one depth, over the hemisphere above, by cubics through the grid as a table interpolates.
    const size_t depth = 5;
    double above = 0;
    for (const auto& [x, weight] : gauss_legendre(64)) {
      const double mu = x * x, place = std::sqrt(1 - mu * mu) * 12;
      const auto cell = std::min(static_cast<size_t>(place), size_t{11});
      const double t = place - static_cast<double>(cell);
      const double w[] = {-t * (t - 1) * (t - 2) / 6, (t * t - 1) * (t - 2) / 2, -t * (t + 1) * (t - 2) / 2,
                          t * (t * t - 1) / 6};
      double toward = 0;
      for (size_t k = 0; k < 4; ++k) toward += w[k] * emission.toward[0][cell + k][depth];
      const Crossing out = fresnel(mu, 1 / n);
      above += weight * 2 * x * 2 * std::numbers::pi * mu * (1 - out.reflectance) / out.cos_t * toward;
    }
    EXPECT_NEAR(above, emission.left[0][depth], 2e-4 * emission.left[0][depth]) << specimen;
  }
}

/// Counts of walks by where their light goes, against the solution: Pearson's chi-square summed over a matrix.
void expect_counts_of_the_solution(const TissueParams& params, double theta_deg, uint64_t seed) {
  const TissueModel model(params);
  const ThreadPool pool(2);
  const FluorescenceTable table(params, pool);
  const Vec3d wi = toward_light(theta_deg);
  RandomStream rng(seed);
  double statistic = 0;
  int freedom = 0;
  for (const double excitation_nm : {400., 440., 550., 650., 680., 720., 750.})
    for (const double emission_nm : {640., 670., 685., 700., 720., 740., 760., 850.}) {
      const Tissue excited = model.at(excitation_nm), emitting = model.at(emission_nm);
      constexpr int kWalks = 4000;
      std::array<double, 3> counts{}, expected{};
      double entered = 0;  // weight of a walk: that of its first refraction
      for (int i = 0; i < kWalks; ++i) {
        const FluorescenceEnd end = walk_fluorescence({excited, emitting}, wi, Absorption::analog, rng);
        if (end.emitted > 0) entered = end.emitted;
        counts[0] += end.left[0] > 0, counts[1] += end.left[1] > 0, counts[2] += end.reabsorbed > 0;
      }
      const FluorescenceEnd mean = table.photons(wi, emission_nm, excitation_nm);
      expected = {mean.left[0], mean.left[1], mean.reabsorbed};
      for (double& e : expected) e *= kWalks / entered;
      std::vector<double> all(counts.begin(), counts.end()), of_all(expected.begin(), expected.end());
      all.push_back(kWalks - counts[0] - counts[1] - counts[2]);
      of_all.push_back(kWalks - expected[0] - expected[1] - expected[2]);
      const ChiSquare cell = chi_square(all, of_all);
      statistic += cell.statistic, freedom += cell.freedom;
    }
  EXPECT_GT(freedom, 100);
  const double p = cdf(complement(boost::math::chi_squared(freedom), statistic));
  EXPECT_GT(p, kFalseAlarm) << theta_deg << " degrees: " << statistic << " with " << freedom << " degrees of freedom";
}

TEST(Fluorescence, OfWalksIsThatOfTheSolution) {
  expect_counts_of_the_solution(leaf_like("soybean"), 8, 1);
  expect_counts_of_the_solution(leaf_like("soybean"), 120, 2);
  expect_counts_of_the_solution(leaf_like("tomato"), 140, 3);
}

TEST(Fluorescence, OfWalksInAUnifacialLeafIsThatOfTheSolution) {
  expect_counts_of_the_solution(leaf_like("maize"), 60, 4);
}

TEST(Fluorescence, OfGrazingLightIsThatOfTheSolution) { expect_counts_of_the_solution(leaf_like("soybean"), 89, 5); }

/// Weighted walks and f, against the solution: false alarms as kFalseAlarm says.
TEST(Fluorescence, HasTheFThatWalksConvergeTo) {
  const TissueParams params = leaf_like("tomato");
  const TissueModel model(params);
  const ThreadPool pool(2);
  const FluorescenceTable table(params, pool);
  const Tissue excited = model.at(650), emitting = model.at(700);
  RandomStream rng(6);
  const double limit = z_limit(12);
  for (const double theta_deg : {20., 150.}) {
    const Vec3d wi = toward_light(theta_deg);
    test::Estimate lit, other;
    constexpr int kWalks = 20000;
    for (int i = 0; i < kWalks; ++i) {
      const FluorescenceEnd end = walk_fluorescence({excited, emitting}, wi, Absorption::weighted, rng);
      EXPECT_NEAR(end.emitted, end.reabsorbed + end.left[0] + end.left[1], 1e-12);
      lit.add(end.left[0]), other.add(end.left[1]);
    }
    const FluorescenceEnd mean = table.photons(wi, 700, 650);
    EXPECT_NEAR(lit.mean(), mean.left[0], limit * lit.standard_error());
    EXPECT_NEAR(other.mean(), mean.left[1], limit * other.standard_error());
    for (const double exit_deg : {10., 60., 85., 110., 170.}) {
      // The azimuth has no effect.
      const double exit = exit_deg * std::numbers::pi / 180;
      const Vec3d wo{std::sin(exit) * 0.6, std::sin(exit) * 0.8, std::cos(exit)};
      test::Estimate f;
      for (int i = 0; i < kWalks; ++i)
        f.add(estimate_fluorescence_f({excited, emitting}, wo, wi, i % 2 ? Absorption::weighted : Absorption::analog,
                                      rng));
      const double solved = table.f(wo, wi, 700, 650);
      EXPECT_NEAR(f.mean(), solved, limit * f.standard_error() + 2e-4 * solved) << theta_deg << " to " << exit_deg;
    }
  }
}

/// Nothing absorbs, or nearly everything at once.
TEST(FluorescenceSolver, HasLimits) {
  TissueParams clear = leaf_like("soybean");
  for (const LeafNumber& n : leaf_parameters())
    if (n.absorbs()) n.value(clear) = 0;
  const TissueModel model(clear);
  const std::vector<double> sines = grid_sines(4);
  const auto with_depth = [&](double depth) { return model.at(690, depth, model.lobes()); };
  const auto sum_of = [](const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum;
  };
  EXPECT_EQ(sum_of(solve_excitation(with_depth(0), sines, 5).absorbed[0][2]), 0);
  const SolvedEmission emission = solve_emission(with_depth(0), sines, 5);
  for (size_t k = 0; k < emission.reabsorbed.size(); ++k)
    EXPECT_NEAR(emission.left[0][k] + emission.left[1][k], 1, 1e-9);
  for (const double depth : {1e3, 1e6}) {
    const std::vector<double> absorbed = solve_excitation(with_depth(depth), sines, 5).absorbed[0][2];
    EXPECT_LE(sum_of(absorbed), 1);
    EXPECT_GT(sum_of(absorbed), 0.9);
    EXPECT_GT(absorbed.front(), 0.8 * sum_of(absorbed));
    const SolvedEmission dark = solve_emission(with_depth(depth), sines, 5);
    EXPECT_GT(dark.reabsorbed[10], 0.999);
  }
}

TEST(FluorescenceTable, IsTheSameForAnyNumberOfThreads) {
  const TissueParams params = leaf_like("soybean");
  const FluorescenceTable one(params, ThreadPool(1)), three(params, ThreadPool(3));
  for (const double theta_deg : {0., 45., 89.9, 170.})
    EXPECT_EQ(one.f(toward_light(30), toward_light(theta_deg), 702, 433),
              three.f(toward_light(30), toward_light(theta_deg), 702, 433));
}

}  // namespace
}  // namespace frond::leaf
