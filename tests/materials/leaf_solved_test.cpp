#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/leaf/statistics.h"
#include "tests/materials/support.h"
#include "tests/support/input_error.h"

namespace frond::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Vec3 direction(float theta_deg, float phi, bool below) {
  const float theta = theta_deg * kPi / 180;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), below ? -std::cos(theta) : std::cos(theta)};
}

/// f of `leaf` against the mean of abm's, lane by lane, in and out of the plane of incidence. The table may be off by
/// its tolerance; beyond it, one false alarm in 1 / kFalseAlarm runs.
void expect_abms_f(const std::string& specimen, const std::string& incident, const std::string& wavelengths) {
  constexpr int kSamples = 20000;
  constexpr double kTolerance = 5e-4 / std::numbers::pi;
  const std::vector<ParsedParam> params{words("specimen", {specimen}), words("incident", {incident})};
  std::vector<ParsedParam> weighted = params;
  weighted.push_back(words("mode", {"weighted"}));
  Ready solved("leaf_solved", params, wavelengths), walk("abm", weighted, wavelengths);
  RandomStream rng(9);
  struct Case {
    float theta_o, theta_i, phi;
    bool below, crosses;
  };
  const Case cases[] = {{30, 60, 0.4f, false, false}, {30, 60, 2, true, false},  {75, 40, 3, false, true},
                        {75, 75, 0, true, true},      {10, 80, 1, false, false}, {80, 80, 3.14f, false, false}};
  const int lanes = solved.lambda().count;
  for (const auto& [theta_o, theta_i, phi, below, crosses] : cases) {
    const Vec3 wo = direction(theta_o, 1, below), wi = direction(theta_i, 1 + phi, below != crosses);
    const SampledSpectrum f = solved.bsdf().f(wo, wi, rng);
    std::array<Estimate, kLanes> walks;
    for (int i = 0; i < kSamples; ++i) {
      const SampledSpectrum sample = walk.bsdf().f(wo, wi, rng);
      for (int lane = 0; lane < lanes; ++lane) walks[static_cast<size_t>(lane)].add(static_cast<double>(sample[lane]));
    }
    for (int lane = 0; lane < lanes; ++lane) {
      const Estimate& mean = walks[static_cast<size_t>(lane)];
      EXPECT_NEAR(static_cast<double>(f[lane]), mean.mean(), kTolerance + mean.standard_error() * z_limit(6 * kLanes))
          << specimen << ", incident " << incident << ", " << theta_o << " to " << theta_i << ", lane " << lane;
    }
  }
}

TEST(LeafSolved, HasTheFThatWalksConvergeTo) {
  expect_abms_f("soybean", "traced", "smpte");
  expect_abms_f("soybean", "light", "smpte");
  expect_abms_f("maize", "traced", "smpte");
}

TEST(LeafSolved, HasTheFThatWalksConvergeToAtWavelengthsThatVary) { expect_abms_f("soybean", "traced", "hero"); }

TEST(LeafSolved, SeenTheOtherWayRoundSwapsItsDirections) {
  Ready traced("leaf_solved", {}), light("leaf_solved", {words("incident", {"light"})});
  EXPECT_TRUE(any(light.bsdf().flags() & Lobes::from_light));
  EXPECT_FALSE(any(traced.bsdf().flags() & Lobes::from_light));
  RandomStream rng(1);
  for (const bool crosses : {false, true}) {
    const Vec3 a = direction(20, 0, false), b = direction(70, 2, crosses);
    EXPECT_EQ(traced.bsdf().f(a, b, rng), light.bsdf().f(b, a, rng));
    EXPECT_NE(traced.bsdf().f(a, b, rng), light.bsdf().f(a, b, rng));
  }
}

TEST(LeafSolved, WeightsAreBounded) {
  RandomStream rng(2);
  for (const char* specimen : {"soybean", "maize"}) {
    Ready leaf("leaf_solved", {words("specimen", {specimen})});
    float largest = 0;
    for (const float theta : {0.f, 30.f, 60.f, 80.f, 89.f, 89.9f})
      for (const bool below : {false, true})
        for (int i = 0; i < 5000; ++i) {
          const auto sample =
              leaf.bsdf().sample(direction(theta, 0, below), rng.uniform(), {rng.uniform(), rng.uniform()}, rng);
          if (sample) largest = std::max(largest, sample->f.max() * std::abs(sample->wi.z) / sample->pdf);
        }
    EXPECT_LT(largest, 4) << specimen;
  }
}

TEST(LeafSolved, FollowsTexturesOfChemistryThicknessAndCuticle) {
  const ParsedParam tolerance{"float", "tolerance", {}, {}, std::vector{2e-3}};
  for (const char* wavelengths : {"smpte", "hero"}) {
    Ready varied("leaf_solved",
                 {texture("chlorophylla", {"1:2"}), texture("thickness", {"0.0001:0.0003"}),
                  texture("cuticleaspect", {"1:7"}), tolerance},
                 wavelengths);
    Ready constant("leaf_solved",
                   {texture("chlorophylla", {"1.25:1.25"}), texture("thickness", {"0.00015:0.00015"}),
                    texture("cuticleaspect", {"2.5:2.5"}), tolerance},
                   wavelengths);
    RandomStream rng(1);
    for (const bool below : {false, true})
      for (const bool crosses : {false, true}) {
        const Vec3 wo = direction(40, 0, below), wi = direction(60, 2, below != crosses);
        const SampledSpectrum a = varied.bsdf({0.25f, 0}).f(wo, wi, rng), b = constant.bsdf().f(wo, wi, rng);
        for (int lane = 0; lane < varied.lambda().count; ++lane)
          EXPECT_NEAR(a[lane], b[lane], 2e-3f / kPi) << wavelengths << ", lane " << lane;
      }
  }
}

TEST(LeafSolved, TakesItsModesFromAFile) {
  const TestFolder folder("leaf_modes");
  // pi f of light that comes back is 0.1 times what the surface makes of it, and of light that crosses 0.2 times.
  const auto column = [](double nm) {
    std::string text = fmt::format("wavelength_nm {} index 1.5 depth 0\n", nm);
    for (const char* side : {"adaxial", "abaxial"})
      for (const double h : {0.1, 0.2 * nm / 500})
        text += fmt::format("{} {} modes 1\n{h} {h} {h}\n{h} {h} {h}\n{h} {h} {h}\n", side,
                            h == 0.1 ? "reflected" : "transmitted", fmt::arg("h", h / std::numbers::pi));
    return text;
  };
  const auto file = [&](const std::string& columns) {
    return words("tablefile", {folder.write("t.modes", "cells 1\nerror 0\n" + columns)});
  };
  RandomStream rng(1);
  const Vec3 down{0, 0, -1};
  const float passage = 0.96f * 0.96f, expected = passage * 0.2f / kPi;
  Ready grey("leaf_solved", {file(column(500))});
  for (int lane = 0; lane < 3; ++lane) EXPECT_NEAR(grey.bsdf().f(-down, down, rng)[lane], expected, 1e-6f);
  Ready spectral("leaf_solved", {file(column(900) + column(300))}, "hero");
  for (int lane = 0; lane < 4; ++lane)
    EXPECT_NEAR(spectral.bsdf().f(-down, down, rng)[lane],
                expected * spectral.lambda().nm[static_cast<size_t>(lane)] / 500, 1e-6f);
  EXPECT_THAT(error_of([&] { Ready("leaf_solved", {file(column(500) + column(600))}); }),
              HasSubstr("is known from 500 to 600 nm, the render needs 455 to 608 nm"));
  EXPECT_THAT(error_of([&] { Ready("leaf_solved", {file("wavelength 551")}); }), HasSubstr("t.modes:3:12: 2 words"));
  expect_sharing_changes_nothing("leaf_solved", {file(column(900) + column(300))});
}

TEST(LeafSolved, RefusesTexturesOfCells) {
  for (const char* name : {"epidermisaspect", "spongyaspect", "palisadeaspect"})
    EXPECT_THAT(error_of([&] { Ready("leaf_solved", {texture(name, {"1:2"})}); }),
                AllOf(HasSubstr(name), HasSubstr("each texel"), HasSubstr("abm")));
}

}  // namespace
}  // namespace frond::test
