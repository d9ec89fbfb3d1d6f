#include "leaf/solve/modes.h"

#include <gtest/gtest.h>

#include <numbers>

#include "leaf/solve/azimuth.h"
#include "leaf/solve/quadrature.h"
#include "leaf/solve/solver.h"
#include "leaf/tissue/specimens.h"
#include "leaf/walk/walk.h"
#include "tests/leaf/statistics.h"
#include "tests/support/slow.h"

namespace frond::leaf {
namespace {

using namespace frond::test;

/// By the midpoint rule, which is exact but for the cut's edge.
double mode_by_sum(double exponent, double mu_axis, double mu, int m) {
  constexpr int kSteps = 5000;
  const double a = mu_axis * mu, b = std::sqrt((1 - mu_axis * mu_axis) * (1 - mu * mu));
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double phi = std::numbers::pi * (i + 0.5) / kSteps;
    if (const double c = a + b * std::cos(phi); c > 0) sum += std::pow(c, exponent) * std::cos(m * phi);
  }
  return sum / kSteps;
}

TEST(AzimuthModes, AreTheCosineTransformOfTheLobe) {
  constexpr int kModes = 12;
  for (const double exponent : {0.0, 0.5, 1.0, 2.5, 5.0, 20.0, 77.7, 100.0}) {
    const AzimuthModes lobe(exponent);
    for (const double mu_axis : {0.01, 0.3, 0.74, 0.99, 1.0})
      for (const double mu : {0.02, 0.3, 0.7, 0.951}) {
        std::array<double, kModes> modes;
        lobe(mu_axis, mu, modes);
        EXPECT_DOUBLE_EQ(modes[0], lobe.mean(mu_axis, mu));
        const double tolerance = exponent < 1 ? 1e-3 : 1e-6;  // the sum's own at the edge
        for (int m = 0; m < kModes; ++m)
          EXPECT_NEAR(modes[static_cast<size_t>(m)], mode_by_sum(exponent, mu_axis, mu, m), tolerance)
              << "exponent " << exponent << ", axis " << mu_axis << ", mu " << mu << ", mode " << m;
      }
  }
}

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

double f_of(const LeafModes& modes, const Tissue& tissue, const Vec3d& wo, const Vec3d& wi, size_t i, size_t o) {
  const size_t count = modes.sines().size();
  const double phi = std::atan2(wi.y, wi.x) - std::atan2(-wo.y, -wo.x);
  double sum = 0;
  double m = 0;
  for (const LeafModes::Grid& h : modes.series(wo.z < 0, wo.z * wi.z < 0))
    sum += h[i * count + o] * std::cos(m++ * phi);
  return interface_transmittance(tissue, std::abs(wo.z), std::abs(wi.z)) * sum;
}

/// At incidence 0 to 89 degrees: mode 0 integrated over all ways out, which are Gaussian in the square root of their
/// cosines and follow the angles of incidence.
void expect_energy_of_solver(const Tissue& tissue, double tolerance) {
  const std::array theta{0.0, 30.0, 60.0, 80.0, 89.0};
  const auto rule = gauss_legendre(24);
  std::vector<double> sines;
  for (const double degrees : theta) sines.push_back(std::sin(radians(degrees)));
  for (const auto& [x, weight] : rule) sines.push_back(std::sqrt(1 - x * x * x * x));
  const LeafModes modes = solve_modes(tissue, sines, 1e-2, mode_nodes(tissue));
  for (size_t i = 0; i < theta.size(); ++i)
    for (const bool below : {false, true}) {
      std::array<double, 2> share{};
      for (const bool crosses : {false, true})
        for (size_t k = 0; k < rule.size(); ++k) {
          const double mu = rule[k].x * rule[k].x;
          share[crosses] += rule[k].weight * 2 * rule[k].x * 2 * std::numbers::pi * mu *
                            interface_transmittance(tissue, std::cos(radians(theta[i])), mu) *
                            modes.series(below, crosses)[0][i * sines.size() + theta.size() + k];
        }
      const Shares expected = solve(tissue, std::array{below ? 180 - theta[i] : theta[i]})[0];
      EXPECT_NEAR(share[0], expected.subsurface, tolerance) << theta[i] << (below ? " from below" : " from above");
      EXPECT_NEAR(share[1], expected.transmitted, tolerance) << theta[i] << (below ? " from below" : " from above");
    }
}

TEST(LeafModes, ModeZeroHoldsTheSolversEnergy) {
  for (const Specimen& specimen : std::span(kSpecimens).first(2))
    for (const bool sieve : {false, true})
      for (const double nm : {455.0, 800.0}) {
        TissueParams params = specimen.params;
        params.sieve_and_detour = sieve;
        const TissueModel model(params);
        expect_energy_of_solver(model.at(nm), 1e-5);
      }
}

Vec3d direction(double theta_deg, double phi, bool below) {
  const double theta = radians(theta_deg), z = std::cos(theta);
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), below ? -z : z};
}

// In the plane of incidence and out of it, both sides: unbiased estimates of so many walks each that their means are
// normal (4000 are too few where hardly any light crosses). One limit for all of the differences and one for their
// chi-square; each raises a false alarm at kFalseAlarm.
TEST(LeafModes, AreTheWalksOwnF) {
  const int samples = slow_tests() ? 1000000 : 16000;
  const std::array theta{30.0, 60.0, 80.0};
  const std::vector<double> phis =
      slow_tests() ? std::vector{0.0, 0.7, 1.3, 2.2, std::numbers::pi} : std::vector{0.0, 1.3, std::numbers::pi};
  std::vector<double> sines;
  for (const double degrees : theta) sines.push_back(std::sin(radians(degrees)));
  std::vector<double> scores;
  RandomStream rng(5);
  for (const Specimen& specimen : std::span(kSpecimens).first(2))
    for (const double nm : {455.0, 800.0}) {
      const TissueModel model(specimen.params);
      const Tissue tissue = model.at(nm);
      const LeafModes modes = solve_modes(tissue, sines, 1e-6, mode_nodes(tissue) + 2);
      for (size_t i = 0; i < theta.size(); ++i)
        for (size_t o = slow_tests() ? 0 : 1; o < theta.size(); ++o)
          for (const double phi : phis)
            for (const bool below : {false, true})
              for (const bool crosses : {false, true}) {
                const Vec3d wo = direction(theta[i], std::numbers::pi, below),
                            wi = direction(theta[o], phi, below != crosses);
                Estimate walks;
                for (int k = 0; k < samples; ++k)
                  walks.add(estimate_subsurface_f(tissue, wo, wi, Absorption::weighted, rng));
                const double f = f_of(modes, tissue, wo, wi, i, o);
                scores.push_back((walks.mean() - f) / walks.standard_error());
              }
    }
  double chi_square = 0;
  const auto count = static_cast<int>(scores.size());
  for (const double z : scores) {
    EXPECT_LT(std::abs(z), z_limit(count));
    chi_square += z * z;
  }
  EXPECT_LT(std::abs(z_of_chi_square(chi_square, count)), z_limit(1));
}

/// Difference and maximum of pi f over a grid of angles and azimuths.
struct Comparison {
  double difference = 0, largest = 0;
};

Comparison compare(const Tissue& tissue, double tolerance, int nodes, int finer_nodes) {
  const std::array theta{0.0, 20.0, 40.0, 60.0, 75.0, 85.0, 89.5};
  std::vector<double> sines;
  for (const double degrees : theta) sines.push_back(std::sin(radians(degrees)));
  const LeafModes modes = solve_modes(tissue, sines, tolerance, nodes);
  const LeafModes finer = solve_modes(tissue, sines, 1e-7, finer_nodes);
  Comparison result;
  for (size_t i = 0; i < theta.size(); ++i)
    for (size_t o = 0; o < theta.size(); ++o)
      for (double phi = 0; phi < 3.2; phi += std::numbers::pi / 8)
        for (const bool below : {false, true})
          for (const bool crosses : {false, true}) {
            const Vec3d wo = direction(theta[i], std::numbers::pi, below),
                        wi = direction(theta[o], phi, below != crosses);
            const double a = std::numbers::pi * f_of(modes, tissue, wo, wi, i, o),
                         b = std::numbers::pi * f_of(finer, tissue, wo, wi, i, o);
            result.difference = std::max(result.difference, std::abs(a - b));
            result.largest = std::max(result.largest, b);
          }
  return result;
}

TEST(LeafModes, AreNearTheirAnswerAtTwiceTheNodes) {
  for (const Specimen& specimen : std::span(kSpecimens).first(2))
    for (const double nm : {455.0, 551.0, 800.0}) {
      const TissueModel model(specimen.params);
      const Tissue tissue = model.at(nm);
      EXPECT_LT(compare(tissue, 1e-7, mode_nodes(tissue), 2 * mode_nodes(tissue)).difference, 3e-5)
          << specimen.name << " at " << nm;
    }
}

TEST(LeafModes, ConvergeAsStatedForOtherLobes) {
  struct {
    double aspect, tolerance;  ///< of the largest pi f, or of 1
  } constexpr kStated[] = {{0, 3e-3}, {0.5, 1e-3}, {2.5, 3e-5}, {20, 3e-5}, {100, 1e-4}};
  for (const auto& [aspect, tolerance] : kStated) {
    TissueParams params = find_specimen("soybean")->params;
    params.epidermis_aspect = params.spongy_aspect = params.palisade_aspect = aspect;
    const TissueModel model(params);
    const Tissue tissue = model.at(800);
    const int nodes = mode_nodes(tissue);
    const auto [difference, largest] = compare(tissue, 1e-7, nodes, nodes * 3 / 2);
    EXPECT_LT(difference, tolerance * std::max(1.0, largest)) << "lobes of " << aspect << ", " << nodes << " nodes";
  }
}

TEST(LeafModes, AreAsManyAsTheAskedErrorTakes) {
  const TissueModel model(find_specimen("soybean")->params);
  const Tissue tissue = model.at(800);
  const int nodes = mode_nodes(tissue);
  for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4})
    EXPECT_LT(compare(tissue, tolerance, nodes, nodes).difference, tolerance) << tolerance;
}

}  // namespace
}  // namespace frond::leaf
