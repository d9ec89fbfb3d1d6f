#include "leaf/solve/depth_solver.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/math/random.h"
#include "leaf/fit/bare_leaf.h"
#include "leaf/fit/optics_surface.h"
#include "leaf/solve/azimuth.h"
#include "leaf/solve/lobe_mean.h"
#include "leaf/tissue/fresnel.h"
#include "leaf/tissue/specimens.h"

namespace frond::leaf {
namespace {

/// Leaves of both structures, with and without the sieve effect, within the ranges of a fit.
std::vector<TissueParams> some_leaves(int count) {
  RandomStream rng(11);
  std::vector<TissueParams> leaves;
  const auto aspect = [&rng] { return 0.7 * std::pow(20 / 0.7, rng.uniform_double()); };
  for (int i = 0; i < count; ++i) {
    TissueParams p = find_specimen(i % 2 == 0 ? "soybean" : "maize")->params;
    p.epidermis_aspect = aspect(), p.spongy_aspect = aspect(), p.palisade_aspect = aspect();
    p.spongy_share = 0.95 * rng.uniform_double(), p.cuticle_refractivity = 0.9 + 0.4 * rng.uniform_double();
    p.sieve_and_detour = i % 4 < 2;
    leaves.push_back(p);
  }
  return leaves;
}

/// R beneath the surface and T of light from above, by the solver of all modes, which eliminates medium after medium.
std::array<double, 2> by_elimination(const Tissue& tissue, double theta_deg, int nodes) {
  const Chain chain(tissue, nodes, 1);
  Sources sources{.ways = 2};
  sources.up[1] = Eigen::MatrixXd::Zero(chain.count(1), 2), sources.down[5] = sources.up[1];
  sources.up[1].col(0) = chain.probability(1, true, true), sources.down[5].col(1) = chain.probability(5, false, true);
  const Prospects inside = ModeSolver(chain, 0, sources).solve(tissue, 2 * nodes);
  const Crossing surface = fresnel(std::cos(theta_deg * std::numbers::pi / 180), 1 / tissue.n_cuticle());
  const Directions& to = chain.directions(1);
  const Eigen::VectorXd axis = Eigen::VectorXd::Constant(1, surface.cos_t);
  Eigen::RowVectorXd row = lobe_modes(tissue.lobe(0, false, true)->exponent(), axis, to.mu, 1)[0].row(0);
  row = row.cwiseProduct(to.weight.transpose()).eval();
  const Eigen::RowVector2d out = (1 - surface.reflectance) / row.sum() * row * inside.from_above;
  return {out[0], out[1]};
}

TEST(DepthSolver, AgreesWithTheEliminationOfMediumAfterMedium) {
  for (const TissueParams& p : some_leaves(8)) {
    const BareLeaf leaf(p);
    for (const double depth : {0.0, 0.1, 2.0}) {
      const Tissue tissue = leaf.at(620, depth);
      const Shares s = solve(tissue, std::array{30.0}, 4)[0];
      const auto [r, t] = by_elimination(tissue, 30, 4);
      EXPECT_NEAR(s.subsurface, r, 1e-11);
      EXPECT_NEAR(s.transmitted, t, 1e-11);
    }
  }
}

TEST(BareLeaf, IsTheLeafOfATissueModel) {
  for (const TissueParams& p : some_leaves(4)) {
    const TissueModel model(p);
    const BareLeaf leaf(p);
    const Tissue a = model.at(733, 0.7, model.lobes()), b = leaf.at(733, 0.7);
    for (size_t m = 0; m < Tissue::kMedia; ++m) {
      EXPECT_NEAR(a.n[m], b.n[m], 1e-14);
      EXPECT_NEAR(a.optical_depth[m], b.optical_depth[m], 1e-14);
    }
    EXPECT_EQ(a.sieve_and_detour, b.sieve_and_detour);
    EXPECT_EQ(a.lobe(2, true, true)->exponent(), b.lobe(2, true, true)->exponent());
  }
}

TEST(LobeMean, IsTheMeanOverAzimuth) {
  Eigen::VectorXd mu(9);
  mu << 1, 0.97, 0.8, 0.72, 0.7, 0.5, 0.2, 0.05, 1e-3;
  for (const double exponent : {0.5, 0.7, 1.0, 1.9, 5.0, 12.34, 20.0, 30.0}) {
    const AzimuthModes lobe(exponent);
    const Eigen::MatrixXd means = LobeMean(exponent).matrix(mu);
    for (Eigen::Index i = 0; i < mu.size(); ++i) {
      const Eigen::RowVectorXd row = LobeMean(exponent).row(mu[i], mu);
      for (Eigen::Index j = 0; j < mu.size(); ++j) {
        EXPECT_NEAR(means(i, j), lobe.mean(mu[i], mu[j]), 1e-5) << exponent << ' ' << mu[i] << ' ' << mu[j];
        EXPECT_NEAR(row[j], means(i, j), 1e-12);
      }
    }
  }
}

/// With fewer nodes for little light the solution has a larger error; 3e-3 here is three times the largest one seen.
TEST(NodeRule, ByFluxIsNearTheFullSolution) {
  for (const TissueParams& p : some_leaves(8)) {
    const BareLeaf leaf(p);
    LobeMeans means;
    const Tissue tissue = leaf.at(900, 0.05);
    const Shares full = solve_depths({&tissue, 1}, std::array{8.0}, {.nodes = 8}, means)[0][0],
                 fast = solve_depths({&tissue, 1}, std::array{8.0}, {.nodes = 4, .by_flux = true}, means)[0][0];
    EXPECT_NEAR(full.subsurface, fast.subsurface, 3e-3);
    EXPECT_NEAR(full.transmitted, fast.transmitted, 3e-3);
  }
}

/// The error is largest where the indices of cuticle and mesophyll are almost equal.
TEST(OpticsSurface, InterpolatesTheSolution) {
  constexpr NodeRule kRule{.nodes = 3};
  const std::array theta_deg{8.0, 150.0};
  for (const TissueParams& p : some_leaves(6)) {
    LobeMeans means;
    const BareLeaf leaf(p);
    const OpticsSurface surface(p, theta_deg, kRule, means);
    for (const double nm : {380.0, 520.0, 735.0, 1450.0, 2300.0})
      for (const double depth : {0.0, 0.03, 0.4, 3.0, 39.0, 100.0}) {
        const Tissue tissue = leaf.at(nm, depth);
        const std::vector<Shares> solved = solve_depths({&tissue, 1}, theta_deg, kRule, means)[0];
        for (size_t a = 0; a < theta_deg.size(); ++a) {
          const auto [r, t] = surface.sum(a, OpticsSurface::weights(nm), OpticsSurface::terms(depth).value);
          EXPECT_NEAR(r, solved[a].surface + solved[a].subsurface, 4e-3) << nm << ' ' << depth;
          EXPECT_NEAR(t, solved[a].transmitted, 4e-3) << nm << ' ' << depth;
        }
      }
  }
}

TEST(OpticsSurface, HasTheSlopeOfItsPolynomials) {
  constexpr double kStep = 1e-5;
  for (const double depth : {0.01, 0.5, 7.0}) {
    const OpticsSurface::Terms here = OpticsSurface::terms(depth), there = OpticsSurface::terms(depth + kStep);
    for (size_t k = 0; k < OpticsSurface::kTerms; ++k)
      EXPECT_NEAR((there.value[k] - here.value[k]) / kStep, here.slope[k], 1e-2 * (1 + std::abs(here.slope[k]))) << k;
  }
}

}  // namespace
}  // namespace frond::leaf
