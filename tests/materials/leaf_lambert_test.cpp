#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "core/log.h"
#include "leaf/solve/solver.h"
#include "leaf/table/table.h"
#include "leaf/tissue/specimens.h"
#include "tests/materials/support.h"
#include "tests/support/input_error.h"

namespace frond::test {
namespace {

using test::number;
using ::testing::HasSubstr;

constexpr Vec3 kUp{0, 0, 1}, kDown{0, 0, -1};

/// Shares of the light from `theta_deg`: all reflected light together, and transmitted light.
struct Pair {
  double reflected = 0, transmitted = 0;
};

/// f times pi, which is the share, for a path that arrives from `wo` and goes to `wi`.
double share(Ready& leaf, const Vec3& wo, const Vec3& wi, int lane, Vec2 uv = {}) {
  RandomStream rng(1);
  return double(leaf.bsdf(uv).f(wo, wi, rng)[lane]) * std::numbers::pi;
}

const ParsedParam kBihemispherical = flag("bihemispherical", true);

/// Mean of one side under diffuse light, by Simpson's rule on the solver's answers at every degree.
Pair diffuse_mean(const leaf::TissueParams& params, double lambda_nm, bool back) {
  const std::vector<double> theta = leaf::even_steps(back ? 90 : 0, back ? 180 : 90, 1);
  const leaf::TissueModel model(params);
  const auto shares = leaf::solve(model.at(lambda_nm), theta);
  Pair mean;
  for (size_t i = 0; i < theta.size(); ++i) {
    const double radians = theta[i] * std::numbers::pi / 180;
    const double simpson = (i == 0 || i + 1 == theta.size() ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) / 3;
    const double weight = simpson * std::abs(std::sin(2 * radians)) * std::numbers::pi / 180;
    mean.reflected += weight * (shares[i].surface + shares[i].subsurface);
    mean.transmitted += weight * shares[i].transmitted;
  }
  return mean;
}

/// Five of them vary from path to path, and two lie within a float's step of each other.
TEST(LeafLambert, TakesBandsHoweverClose) {
  Resolver resolver;
  const WavelengthsInfo& bands = PluginTable<WavelengthsInfo>("wavelengths", builtin_wavelengths()).get("bands", {});
  const auto strategy = test::make_plugin(bands, {number("float", "wavelengths", {500, 600, 600.00001, 700, 800})});
  const MaterialInfo& info = material_info("leaf_lambert");
  const auto leaf = info.make(Params(info, {"", {}, {words("specimen", {"soybean"})}}, resolver));
  ThreadPool pool(1);
  leaf->prepare({*strategy, pool, silent_log(), {}});
  Arena arena;
  RandomStream rng(1);
  for (uint64_t index = 0; index < 5; ++index) {
    const SampledWavelengths lambda = strategy->sample_for_index(index, 0);
    const Bsdf& bsdf = *leaf->evaluate({{}, kUp, Frame::around(kUp), {}}, lambda, arena);
    for (int lane = 0; lane < kLanes; ++lane) EXPECT_GT(bsdf.f(kUp, kUp, rng)[lane], 0) << index;
  }
}

TEST(LeafLambert, HasTheMeansUnderDiffuseLight) {
  for (const std::string specimen : {"soybean", "maize"}) {
    Ready leaf("leaf_lambert", {words("specimen", {specimen}), kBihemispherical});
    for (int lane = 0; lane < 3; ++lane)
      for (const bool back : {false, true}) {
        const Vec3 lit = back ? kDown : kUp, other = back ? kUp : kDown;
        const Pair mean = diffuse_mean(leaf::find_specimen(specimen)->params,
                                       double(leaf.lambda().nm[static_cast<size_t>(lane)]), back);
        EXPECT_NEAR(share(leaf, lit, lit, lane), mean.reflected, 2e-5) << specimen << lane << back;
        EXPECT_NEAR(share(leaf, lit, other, lane), mean.transmitted, 2e-5) << specimen << lane << back;
      }
  }
}

TEST(LeafLambert, HasTheMeansUnderDiffuseLightWhateverItsSurface) {
  for (const double aspect : {0.0, 1.0, 100.0, 1000.0}) {
    Ready leaf("leaf_lambert", {number("float", "cuticleaspect", {aspect}), kBihemispherical});
    leaf::TissueParams params = leaf::find_specimen("soybean")->params;
    params.cuticle_aspect = aspect;
    const Pair mean = diffuse_mean(params, 551, false);
    EXPECT_NEAR(share(leaf, kUp, kUp, 1), mean.reflected, 2e-4) << aspect;
    EXPECT_NEAR(share(leaf, kUp, kDown, 1), mean.transmitted, 2e-4) << aspect;
  }
}

void expect_shares_at(Ready& leaf, double theta_deg) {
  const leaf::TissueModel soybean(leaf::find_specimen("soybean")->params);
  const std::array<double, 2> theta{theta_deg, 180 - theta_deg};
  for (int lane = 0; lane < 3; ++lane) {
    const auto s = leaf::solve(soybean.at(double(leaf.lambda().nm[static_cast<size_t>(lane)])), theta);
    EXPECT_NEAR(share(leaf, kUp, kUp, lane), s[0].surface + s[0].subsurface, 1e-6);
    EXPECT_NEAR(share(leaf, kUp, kDown, lane), s[0].transmitted, 1e-6);
    EXPECT_NEAR(share(leaf, kDown, kDown, lane), s[1].surface + s[1].subsurface, 1e-6);
    EXPECT_NEAR(share(leaf, kDown, kUp, lane), s[1].transmitted, 1e-6);
  }
}

TEST(LeafLambert, HasTheSharesOfAnIntegratingSphereOrOfOneAngle) {
  Ready sphere("leaf_lambert", {}), at_40("leaf_lambert", {number("float", "incidence", {40})});
  expect_shares_at(sphere, 8);
  expect_shares_at(at_40, 40);
  EXPECT_THAT(error_of([] {
                Ready("leaf_lambert", {kBihemispherical, number("float", "incidence", {8})});
              }),
              HasSubstr("\"incidence\" has no effect with \"bihemispherical\""));
}

TEST(LeafLambert, TakesTheIncidentSideFromTheRayOrTheLight) {
  Ready traced("leaf_lambert", {}), light("leaf_lambert", {words("incident", {"light"})});
  for (int lane = 0; lane < 3; ++lane) {
    EXPECT_EQ(share(traced, kUp, kDown, lane), share(light, kDown, kUp, lane));
    EXPECT_EQ(share(traced, kUp, kUp, lane), share(light, kUp, kUp, lane));
  }
  // The two sides of this leaf transmit differently, so that the two conventions do.
  EXPECT_GT(std::abs(share(traced, kUp, kDown, 1) - share(light, kUp, kDown, 1)), 1e-3);
}

TEST(LeafLambert, InterpolatesWhereWavelengthsVary) {
  Ready leaf("leaf_lambert", {kBihemispherical}, "hero");
  for (int lane = 0; lane < 4; ++lane) {
    const double nm = double(leaf.lambda().nm[static_cast<size_t>(lane)]);
    const Pair mean = diffuse_mean(leaf::find_specimen("soybean")->params, nm, false);
    EXPECT_NEAR(share(leaf, kUp, kUp, lane), mean.reflected, 1e-3) << nm;
    EXPECT_NEAR(share(leaf, kUp, kDown, lane), mean.transmitted, 1e-3) << nm;
  }
}

TEST(LeafLambert, IsExactAtTheWavelengthsOfAList) {
  Ready leaf("leaf_lambert", {kBihemispherical}, "bands");
  for (int lane = 0; lane < 4; ++lane) {
    const double nm = double(leaf.lambda().nm[static_cast<size_t>(lane)]);
    const Pair mean = diffuse_mean(leaf::find_specimen("soybean")->params, nm, true);
    EXPECT_NEAR(share(leaf, kDown, kDown, lane), mean.reflected, 2e-5) << nm;
    EXPECT_NEAR(share(leaf, kDown, kUp, lane), mean.transmitted, 2e-5) << nm;
  }
}

/// Linear interpolation over steps of 10 % of the depth changes shares by 4e-4 at most.
TEST(LeafLambert, TakesTexturesOfChemistry) {
  for (const char* wavelengths : {"smpte", "hero", "bands"})
    for (const bool reciprocal : {false, true}) {
      const ParsedParam incident = words("incident", {reciprocal ? "reciprocal" : "traced"});
      Ready varied("leaf_lambert",
                   {texture("chlorophylla", {"1:4"}), texture("thickness", {"0.0001:0.0003"}), incident}, wavelengths);
      for (const float u : {0.1f, 0.5f, 0.9f}) {
        const double chlorophyll = 1 + 3 * double(u), thickness = 1e-4 + 2e-4 * double(u);
        Ready constant(
            "leaf_lambert",
            {number("float", "chlorophylla", {chlorophyll}), number("float", "thickness", {thickness}), incident},
            wavelengths);
        for (int lane = 0; lane < varied.lambda().count; ++lane)
          for (const Vec3& wo : {kUp, kDown})
            for (const Vec3& wi : {kUp, kDown})
              EXPECT_NEAR(share(varied, wo, wi, lane, {u, u}), share(constant, wo, wi, lane), 1e-3)
                  << wavelengths << reciprocal << u << lane;
      }
    }
}

TEST(LeafLambert, RefusesTexturesOfWallsByName) {
  EXPECT_THAT(error_of([] { Ready("leaf_lambert", {texture("spongyaspect", {"3:30"})}); }),
              HasSubstr("leaf_lambert takes no texture for \"spongyaspect\""));
  EXPECT_EQ(error_of([] { Ready("leaf_lambert", {texture("spongyaspect", {"3:3"})}); }), "");
}

TEST(LeafLambert, TakesMeasurementsAsTheyAre) {
  const TestFolder folder("leaf_lambert");
  const std::string csv = folder.write("leaf.csv",
                                       "wavelength,R (%),T (%),side\n"
                                       "455,4,1,upper\n551,10,12,upper\n608,6,8,upper\n"
                                       "455,5,1,lower\n551,13,11,lower\n608,9,7,lower\n");
  Ready leaf("leaf_lambert", {words("tablefile", {csv})});
  const double expected[3][4] = {{0.06, 0.08, 0.09, 0.07}, {0.10, 0.12, 0.13, 0.11}, {0.04, 0.01, 0.05, 0.01}};
  for (int lane = 0; lane < 3; ++lane) {
    EXPECT_FLOAT_EQ(float(share(leaf, kUp, kUp, lane)), float(expected[lane][0]));
    EXPECT_FLOAT_EQ(float(share(leaf, kUp, kDown, lane)), float(expected[lane][1]));
    EXPECT_FLOAT_EQ(float(share(leaf, kDown, kDown, lane)), float(expected[lane][2]));
    EXPECT_FLOAT_EQ(float(share(leaf, kDown, kUp, lane)), float(expected[lane][3]));
  }
}

/// Angles of a leaf table: the file's angles exactly, and the mean over all of them.
TEST(LeafLambert, TakesLeafTables) {
  const TestFolder folder("leaf_lambert");
  const std::string rows = "8,500,0.04,0.06,0.1\n40,500,0.05,0.07,0.09\n80,500,0.3,0.1,0.05\n";
  const std::string csv = folder.write("leaf.csv", "theta_deg,wavelength_nm,Rs,Rd,T\n" + rows);
  Ready at_8("leaf_lambert", {words("tablefile", {csv})}),
      at_40("leaf_lambert", {words("tablefile", {csv}), number("float", "incidence", {40})}),
      mean("leaf_lambert", {words("tablefile", {csv}), kBihemispherical});
  EXPECT_FLOAT_EQ(float(share(at_8, kUp, kUp, 0)), 0.10f);
  EXPECT_FLOAT_EQ(float(share(at_40, kUp, kUp, 0)), 0.12f);
  EXPECT_FLOAT_EQ(float(share(at_40, kDown, kUp, 0)), 0.09f);
  EXPECT_GT(share(mean, kUp, kUp, 0), 0.12);
  EXPECT_LT(share(mean, kUp, kUp, 0), 0.40);
}

}  // namespace
}  // namespace frond::test
