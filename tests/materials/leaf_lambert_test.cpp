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

using ::testing::HasSubstr;
using testing::number;

constexpr Vec3 kUp{0, 0, 1}, kDown{0, 0, -1};

/// What light from `theta_deg` leaves as, all that is reflected together.
struct Pair {
  double reflected = 0, transmitted = 0;
};

/// f times pi, which is the share, for a path that arrives from `wo` and goes to `wi`.
double share(Ready& leaf, const Vec3& wo, const Vec3& wi, int lane) {
  RandomStream rng(1);
  return double(leaf.bsdf().f(wo, wi, rng)[lane]) * std::numbers::pi;
}

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
  const auto strategy = testing::make_plugin(bands, {number("float", "wavelengths", {500, 600, 600.00001, 700, 800})});
  const MaterialInfo& info = material_info("leaf_lambert");
  const auto leaf = info.make(Params(info, {"", {}, {words("specimen", {"soybean"})}}, resolver));
  ThreadPool pool(1);
  leaf->prepare({*strategy, pool, silent_log(), {}});
  Arena arena;
  RandomStream rng(1);
  for (uint64_t index = 0; index < 5; ++index) {
    const SampledWavelengths lambda = strategy->sample_in_turn(index, 0);
    const Bsdf& bsdf = *leaf->evaluate({{}, kUp, Frame::around(kUp), {}}, lambda, arena);
    for (int lane = 0; lane < kLanes; ++lane) EXPECT_GT(bsdf.f(kUp, kUp, rng)[lane], 0) << index;
  }
}

TEST(LeafLambert, HasTheMeansUnderDiffuseLight) {
  for (const std::string specimen : {"soybean", "maize"}) {
    Ready leaf("leaf_lambert", {words("specimen", {specimen})});
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
    Ready leaf("leaf_lambert", {number("float", "cuticleaspect", {aspect})});
    leaf::TissueParams params = leaf::find_specimen("soybean")->params;
    params.cuticle_aspect = aspect;
    const Pair mean = diffuse_mean(params, 551, false);
    EXPECT_NEAR(share(leaf, kUp, kUp, 1), mean.reflected, 2e-4) << aspect;
    EXPECT_NEAR(share(leaf, kUp, kDown, 1), mean.transmitted, 2e-4) << aspect;
  }
}

TEST(LeafLambert, HasTheSharesOfOneAngleWhereItIsAsked) {
  Ready leaf("leaf_lambert", {number("float", "incidence", {8})});
  const leaf::TissueModel soybean(leaf::find_specimen("soybean")->params);
  const std::array<double, 2> theta{8, 172};
  for (int lane = 0; lane < 3; ++lane) {
    const auto s = leaf::solve(soybean.at(double(leaf.lambda().nm[static_cast<size_t>(lane)])), theta);
    EXPECT_NEAR(share(leaf, kUp, kUp, lane), s[0].surface + s[0].subsurface, 1e-6);
    EXPECT_NEAR(share(leaf, kUp, kDown, lane), s[0].transmitted, 1e-6);
    EXPECT_NEAR(share(leaf, kDown, kDown, lane), s[1].surface + s[1].subsurface, 1e-6);
    EXPECT_NEAR(share(leaf, kDown, kUp, lane), s[1].transmitted, 1e-6);
  }
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
  Ready leaf("leaf_lambert", {}, "hero");
  for (int lane = 0; lane < 4; ++lane) {
    const double nm = double(leaf.lambda().nm[static_cast<size_t>(lane)]);
    const Pair mean = diffuse_mean(leaf::find_specimen("soybean")->params, nm, false);
    EXPECT_NEAR(share(leaf, kUp, kUp, lane), mean.reflected, 1e-3) << nm;
    EXPECT_NEAR(share(leaf, kUp, kDown, lane), mean.transmitted, 1e-3) << nm;
  }
}

TEST(LeafLambert, IsExactAtTheWavelengthsOfAList) {
  Ready leaf("leaf_lambert", {}, "bands");
  for (int lane = 0; lane < 4; ++lane) {
    const double nm = double(leaf.lambda().nm[static_cast<size_t>(lane)]);
    const Pair mean = diffuse_mean(leaf::find_specimen("soybean")->params, nm, true);
    EXPECT_NEAR(share(leaf, kDown, kDown, lane), mean.reflected, 2e-5) << nm;
    EXPECT_NEAR(share(leaf, kDown, kUp, lane), mean.transmitted, 2e-5) << nm;
  }
}

TEST(LeafLambert, RefusesTexturesByName) {
  EXPECT_THAT(error_of([] { Ready("leaf_lambert", {texture("chlorophylla", {"3:30"})}); }),
              HasSubstr("leaf_lambert takes no textures: its parameters are those of the whole leaf"));
  EXPECT_EQ(error_of([] { Ready("leaf_lambert", {texture("chlorophylla", {"3:3"})}); }), "");
}

}  // namespace
}  // namespace frond::test
