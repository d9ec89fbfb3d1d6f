#include <gtest/gtest.h>

#include <numbers>

#include "instruments/errors/statistics.h"
#include "tests/materials/support.h"
#include "tests/support/slow.h"

/// The expectation of abm's f is known without noise: the solution of the same walk. A bias is therefore compared with
/// the noise of one estimate and not of two.
namespace frond::test {
namespace {

ParsedParam number(std::string name, double value) { return {"float", std::move(name), {}, {}, std::vector{value}}; }

/// Parameters of a leaf for abm, and for leaf_solved if it needs others.
struct Leaf {
  std::string name;
  std::vector<ParsedParam> walked;
  std::vector<ParsedParam> solved = {};
  std::string wavelengths = "smpte";
  Vec2 uv = {};
  int first_active = 0;  ///< lanes before it have been retired
};

std::vector<Leaf> leaves() {
  const ParsedParam weighted = words("mode", {"weighted"}), from_light = words("incident", {"light"}),
                    maize = words("specimen", {"maize"});
  return {
      {"soybean", {}},
      {"soybean, weighted", {weighted}},
      {"soybean, light incident", {from_light, weighted}, {from_light}},
      {"soybean, sieve", {flag("sieve", true)}, {flag("sieve", true)}},
      {"maize", {maize}, {maize}},
      {"maize, light incident, sieve",
       {maize, from_light, flag("sieve", true)},
       {maize, from_light, flag("sieve", true)}},
      {"maize, four wavelengths", {maize, weighted}, {maize}, "meyer"},
      {"soybean, four wavelengths, two of them retired", {weighted}, {}, "meyer", {}, 2},
      {"no mesophyll", {number("mesophyllfraction", 0)}, {number("mesophyllfraction", 0)}},
      {"as green as can be", {number("chlorophylla", 100), weighted}, {number("chlorophylla", 100)}},
      {"thin, narrow lobes",
       {number("thickness", 1e-5), number("epidermisaspect", 9), number("spongyaspect", 12)},
       {number("thickness", 1e-5), number("epidermisaspect", 9), number("spongyaspect", 12)}},
      {"textures everywhere",
       {texture("chlorophylla", {"1:5"}), texture("thickness", {"0.0001:0.0002"}), texture("epidermisaspect", {"3:7"}),
        texture("spongyaspect", {"2:6"}), texture("palisadeaspect", {"1:5"}), texture("cuticleaspect", {"4:8"})},
       {number("chlorophylla", 3), number("thickness", 1.5e-4), number("epidermisaspect", 5), number("spongyaspect", 4),
        number("palisadeaspect", 3), number("cuticleaspect", 6)},
       "smpte",
       {0.5f, 0}},
  };
}

void PrintTo(const Leaf& leaf, std::ostream* out) { *out << leaf.name; }

struct Pair {
  Vec3 wo, wi;
};

/// All over both sides, grazing ones among them.
std::vector<Pair> pairs(int count) {
  RandomStream rng(77);
  const auto direction = [&rng] {
    const double z = 2 * rng.uniform_double() - 1, phi = 2 * std::numbers::pi * rng.uniform_double();
    const double cos_theta = z * std::abs(z), sin_theta = std::sqrt(1 - cos_theta * cos_theta);
    return Vec3{static_cast<float>(sin_theta * std::cos(phi)), static_cast<float>(sin_theta * std::sin(phi)),
                static_cast<float>(cos_theta)};
  };
  std::vector<Pair> result;
  for (int i = 0; i < count; ++i) result.push_back({direction(), direction()});
  return result;
}

std::vector<ParsedParam> finely(std::vector<ParsedParam> params) {
  params.push_back(number("tolerance", 1e-5));
  return params;
}

/// By how many standard errors a mean is further from `expected` than the table may be.
double score(const Estimate& mean, double expected, double slack) {
  const double difference = mean.mean - expected, beyond = std::max(0.0, std::abs(difference) - slack);
  return beyond == 0 ? 0 : std::copysign(beyond / mean.standard_error(), difference);
}

class AbmF : public ::testing::TestWithParam<Leaf> {};

// Each raises a false alarm in one of 10^6 seeds: a limit for single pairs at one wavelength, and one for what all of
// them have in common.
TEST_P(AbmF, IsTheSolvedOneOnAverage) {
  constexpr double kFalseAlarm = 1e-6;
  constexpr double kTable = 4e-5 / std::numbers::pi, kSingle = 1e-6;  // tolerance and nodes; rounding
  const int samples = slow_tests() ? 1000000 : 5000;
  const Leaf& leaf = GetParam();
  Ready walk("abm", leaf.walked, leaf.wavelengths), solved("leaf_solved", finely(leaf.solved), leaf.wavelengths);
  walk.retire_lanes(leaf.first_active), solved.retire_lanes(leaf.first_active);
  const Bsdf &walked_bsdf = walk.bsdf(leaf.uv), &solved_bsdf = solved.bsdf();
  const std::vector<Pair> all = pairs(24);
  const int lanes = walk.lambda().count;
  RandomStream rng(9);
  double sum = 0;
  for (const auto& [wo, wi] : all) {
    const SampledSpectrum exact = solved_bsdf.f(wo, wi, rng);
    std::array<Moments, kLanes> walks;
    for (int i = 0; i < samples; ++i) {
      const SampledSpectrum f = walked_bsdf.f(wo, wi, rng);
      for (int lane = 0; lane < lanes; ++lane) walks[static_cast<size_t>(lane)].add(static_cast<double>(f[lane]));
    }
    for (int lane = 0; lane < lanes; ++lane) {
      const Estimate mean = walks[static_cast<size_t>(lane)].estimate();
      const double expected = static_cast<double>(exact[lane]), slack = kTable + kSingle * expected;
      EXPECT_GT(equality_p(mean, {expected, 0, 0}, slack),
                sidak_level(kFalseAlarm, all.size() * static_cast<size_t>(lanes)))
          << mean.mean << " +- " << mean.standard_error() << ", solved " << expected << ", lane " << lane << ", wo.z "
          << wo.z << ", wi.z " << wi.z;
      if (lane != leaf.first_active) continue;  // others are of the same walks
      sum += score(mean, expected, slack);
    }
  }
  EXPECT_GT(2 * normal_upper_tail(std::abs(sum) / std::sqrt(static_cast<double>(all.size()))), kFalseAlarm);
}

INSTANTIATE_TEST_SUITE_P(Leaves, AbmF, ::testing::ValuesIn(leaves()), [](const auto& instance) {
  std::string name = instance.param.name;
  std::erase_if(name, [](char c) { return c == ','; });
  std::ranges::replace(name, ' ', '_');
  return name;
});

}  // namespace
}  // namespace frond::test
