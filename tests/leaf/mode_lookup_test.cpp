#include "leaf/table/mode_lookup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "core/math/random.h"
#include "leaf/solve/quadrature.h"
#include "leaf/solve/solver.h"
#include "leaf/table/mode_table_file.h"
#include "leaf/tissue/specimens.h"

namespace frond::leaf {
namespace {

constexpr double kPi = std::numbers::pi;

ModeTableRequest request_of(std::string_view specimen, double tolerance,
                            std::vector<double> wavelengths = {608, 551, 455}) {
  return {.params = find_specimen(specimen)->params, .wavelengths_nm = std::move(wavelengths), .tolerance = tolerance};
}

SampledWavelengths lanes_of(const std::vector<double>& nm) {
  SampledWavelengths lambda;
  for (const double x : nm) {
    const auto i = static_cast<size_t>(lambda.count++);
    lambda.nm[i] = static_cast<float>(x);
    lambda.pdf[i] = 1;
    lambda.active[i] = true;
  }
  return lambda;
}

double cosine(double sine) { return std::sqrt(1 - sine * sine); }

/// Largest difference of pi f between what a table gives and modes solved at the same directions, at random sines and
/// azimuths.
double largest_error(const ModeLookup& table, const Tissue& tissue, const ModeLookup::Selection& selection, int lane) {
  RandomStream rng(3);
  std::vector<double> sines;
  for (int i = 0; i < 24; ++i) sines.push_back(std::sqrt(rng.uniform_double()) * 0.9999);
  const LeafModes exact = solve_modes(tissue, sines, 1e-7, mode_nodes(tissue));
  double largest = 0;
  for (size_t i = 0; i < sines.size(); ++i)
    for (size_t o = 0; o < sines.size(); ++o)
      for (const bool below : {false, true})
        for (const bool crosses : {false, true}) {
          const double phi = kPi * rng.uniform_double();
          double sum = 0, m = 0;
          for (const LeafModes::Grid& h : exact.series(below, crosses))
            sum += h[i * sines.size() + o] * std::cos(m++ * phi);
          const auto node = [&](size_t k) { return table.nodes(static_cast<float>(sines[k])); };
          const float looked_up = table.series(below, crosses, node(i), node(o), static_cast<float>(std::cos(phi)),
                                               selection.columns)[lane];
          const double scale = kPi * interface_transmittance(tissue, cosine(sines[i]), cosine(sines[o]));
          largest = std::max(largest, scale * std::abs(sum - static_cast<double>(looked_up)));
        }
  return largest;
}

TEST(ModeLookup, StaysWithinItsTolerance) {
  const ThreadPool pool(2);
  for (const Specimen& specimen : std::span(kSpecimens).first(2))
    for (const double tolerance : {1e-2, 5e-4, 1e-4}) {
      const ModeTableRequest request = request_of(specimen.name, tolerance);
      const ModeTable spectrum = make_mode_table(request, pool);
      EXPECT_LT(spectrum.error, tolerance);
      const ModeLookup table(request, spectrum, false);
      const auto selection = table.select(lanes_of(request.wavelengths_nm));
      const TissueModel model(request.params);
      for (size_t lane = 0; lane < request.wavelengths_nm.size(); ++lane)
        EXPECT_LT(largest_error(table, model.at(request.wavelengths_nm[lane]), selection, static_cast<int>(lane)),
                  tolerance)
            << specimen.name << " at " << request.wavelengths_nm[lane] << " nm";
    }
}

TEST(ModeTable, LeavesHalfOfItsToleranceToMissingModesAtEveryWavelength) {
  const ModeTableRequest request = request_of("soybean", 5e-4, {551, 800, 1450, 1940, 2500});
  EXPECT_LE(make_mode_table(request, ThreadPool(2)).error, request.tolerance / 2);
}

TEST(ModeLookup, IsSmall) {
  const ThreadPool pool(2);
  const ModeTableRequest request = request_of("soybean", 5e-4);
  EXPECT_LT(ModeLookup(request, make_mode_table(request, pool), false).bytes(), size_t{64 * 1024});
}

/// At medium angles, the integral of the looked-up values equals the solver's shares.
TEST(ModeLookup, HoldsTheSolversEnergy) {
  constexpr double kTolerance = 5e-4;
  const ThreadPool pool(2);
  for (const Specimen& specimen : std::span(kSpecimens).first(2)) {
    const ModeTableRequest request = request_of(specimen.name, kTolerance, {455, 800});
    const ModeLookup table(request, make_mode_table(request, pool), false);
    const auto selection = table.select(lanes_of(request.wavelengths_nm));
    const TissueModel model(request.params);
    for (const double theta : {0.0, 17.0, 33.0, 51.0, 70.0, 82.0, 89.0})
      for (const bool below : {false, true})
        for (int lane = 0; lane < 2; ++lane) {
          const Tissue tissue = model.at(request.wavelengths_nm[static_cast<size_t>(lane)]);
          const Shares expected = solve(tissue, std::array{below ? 180 - theta : theta})[0];
          const auto nodes = table.nodes(static_cast<float>(std::sin(theta * kPi / 180)));
          Float4 light{};
          light[lane] = static_cast<float>(1 - expected.surface);
          const ModeLookup::Ways ways = table.ways(below, nodes, light, selection.columns);
          const ModeLookup::Ways other = table.ways(!below, nodes, light, selection.columns);
          EXPECT_NEAR(static_cast<double>(ways.back), expected.subsurface, kTolerance / 4) << theta;
          EXPECT_NEAR(static_cast<double>(ways.across), expected.transmitted, kTolerance / 4) << theta;
          EXPECT_EQ(other.across_to, ways.across);
        }
  }
}

TEST(ModeLookup, LiesBetweenWavelengths) {
  const ThreadPool pool(2);
  std::vector<double> grid;
  for (double nm = 540; nm <= 560; nm += 2.5) grid.push_back(nm);
  const ModeTableRequest request = request_of("soybean", 1e-3, grid);
  const ModeLookup table(request, make_mode_table(request, pool), true);
  const std::vector<double> wanted{541.2, 550, 553.7, 559.9};
  const auto selection = table.select(lanes_of(wanted));
  const TissueModel model(request.params);
  for (size_t lane = 0; lane < wanted.size(); ++lane) {
    const Tissue tissue = model.at(wanted[lane]);
    EXPECT_NEAR(selection.index[static_cast<int>(lane)], tissue.n_cuticle(), 1e-4);
    EXPECT_LT(largest_error(table, tissue, selection, static_cast<int>(lane)), 1e-3) << wanted[lane];
  }
}

/// 189 wavelengths as mixtures of a few functions, at wavelengths all over the spectrum.
TEST(ModeLookup, IsSmallAndRightOverTheSpectrum) {
  constexpr double kTolerance = 1e-3;
  const ThreadPool pool(2);
  std::vector<double> grid;
  for (double nm = 360; nm <= 830; nm += 2.5) grid.push_back(nm);
  for (const Specimen& specimen : std::span(kSpecimens).first(2)) {
    const ModeTableRequest request = request_of(specimen.name, kTolerance, grid);
    const ModeLookup table(request, make_mode_table(request, pool), true);
    EXPECT_LT(table.bytes(), size_t{256 * 1024});
    const std::vector<double> wanted{362.5, 450, 550, 675};
    const auto selection = table.select(lanes_of(wanted));
    const TissueModel model(request.params);
    for (size_t lane = 0; lane < wanted.size(); ++lane)
      EXPECT_LT(largest_error(table, model.at(wanted[lane]), selection, static_cast<int>(lane)), kTolerance)
          << specimen.name << " at " << wanted[lane];
  }
}

TEST(ModeLookup, LiesBetweenDepths) {
  const ThreadPool pool(2);
  ModeTableRequest request = request_of("soybean", 5e-4, {608, 551});
  request.depths = DepthAxis(0.1, 0.4, 0.1);
  const ModeLookup table(request, make_mode_table(request, pool), false);
  const auto selection = table.select(lanes_of(request.wavelengths_nm), {0.17, 0.323});
  const TissueModel model(request.params);
  EXPECT_LT(largest_error(table, model.at(608, 0.17, model.lobes()), selection, 0), 1e-3);
  EXPECT_LT(largest_error(table, model.at(551, 0.323, model.lobes()), selection, 1), 1e-3);
}

TEST(ModeLookup, NeverGivesLessThanNothing) {
  const ThreadPool pool(2);
  const ModeTableRequest request = request_of("soybean", 0.1);
  const ModeLookup table(request, make_mode_table(request, pool), false);
  const auto selection = table.select(lanes_of(request.wavelengths_nm));
  for (float a = 0; a <= 1; a += 0.1f)
    for (float b = 0; b <= 1; b += 0.1f)
      for (float c = -1; c <= 1; c += 0.25f)
        for (const bool below : {false, true})
          for (const bool crosses : {false, true}) {
            const Float4 s = table.series(below, crosses, table.nodes(a), table.nodes(b), c, selection.columns);
            for (int lane = 0; lane < 3; ++lane) EXPECT_GE(s[lane], 0);
          }
}

TEST(ModeTable, DoesNotDependOnThreads) {
  const ModeTableRequest request = request_of("soybean", 1e-2, {455, 551, 680});
  EXPECT_EQ(to_text(request, make_mode_table(request, ThreadPool(1)), ""),
            to_text(request, make_mode_table(request, ThreadPool(3)), ""));
}

}  // namespace
}  // namespace frond::leaf
