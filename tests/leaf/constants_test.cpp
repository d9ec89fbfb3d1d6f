#include "leaf/tissue/constants.h"

#include <gtest/gtest.h>

#include <cmath>

#include "leaf/tissue/absorption.h"
#include "leaf/tissue/prospect.h"
#include "leaf/tissue/specimens.h"
#include "leaf/tissue/tissue.h"

namespace frond::leaf {
namespace {

TEST(LeafConstants, HoldTheFirstValueBelowTheData) {
  EXPECT_EQ(constants_at(360).chlorophyll, constants_at(400).chlorophyll);
  EXPECT_EQ(constants_at(399).n_cuticle, 1.54);
}

TEST(LeafConstants, AreLinearBetweenNodes) {
  EXPECT_DOUBLE_EQ(constants_at(405).chlorophyll, (7340 + 6230) / 2.0);
  EXPECT_DOUBLE_EQ(constants_at(2475).n_antidermal_wall, (1.376 + 1.371) / 2);
}

TEST(LeafConstants, ReachFromVioletToShortWaveInfrared) {
  for (double nm = 360; nm <= 2500; nm += 1) {
    const Constants c = constants_at(nm);
    for (const double absorption : {c.chlorophyll, c.carotenoids, c.protein, c.cellulose, c.water})
      ASSERT_TRUE(std::isfinite(absorption) && absorption >= 0) << nm;
    for (const double n : {c.n_cuticle, c.n_mesophyll, c.n_antidermal_wall}) ASSERT_TRUE(n > 1.3 && n < 1.6) << nm;
    ASSERT_GE(c.n_cuticle, c.n_mesophyll) << nm;
    ASSERT_GE(c.n_mesophyll, c.n_antidermal_wall) << nm;
  }
}

TEST(LeafConstants, ChlorophyllAbsorbsLeastOfTheVisibleAt550To555) {
  const double least = constants_at(550).chlorophyll;
  EXPECT_EQ(constants_at(555).chlorophyll, least);
  for (double nm = 400; nm <= 680; nm += 5) EXPECT_GE(constants_at(nm).chlorophyll, least) << nm;
}

TEST(LeafConstants, OfProspectAreLinearBetweenNodes) {
  EXPECT_DOUBLE_EQ(prospect_constants_at(400).carotenoids, 16734);
  EXPECT_DOUBLE_EQ(prospect_constants_at(380).carotenoids, 16734);
  EXPECT_NEAR(prospect_constants_at(402.5).anthocyanins, (6667.47 + 5669.94) / 2, 1e-9);
  EXPECT_DOUBLE_EQ(prospect_constants_at(1000).dry_matter, 0);
  for (double nm = 360; nm <= 2500; nm += 1) {
    const ProspectConstants c = prospect_constants_at(nm);
    for (const double absorption : {c.chlorophyll, c.carotenoids, c.anthocyanins, c.water, c.dry_matter})
      ASSERT_TRUE(std::isfinite(absorption) && absorption >= 0) << nm;
  }
}

TEST(TissueModel, TakesProspectsAbsorptionIfAsked) {
  TissueParams p = find_specimen("soybean")->params;
  const double published = absorption_coefficient(p, 670);
  p.number("anthocyanins") = 2, p.number("drymatter") = 100, p.number("brownpigments") = 3000;
  const ProspectConstants c = prospect_constants_at(670);
  EXPECT_NEAR(absorption_coefficient(p, 670),
              published + 2 * c.anthocyanins + 100 * c.dry_matter + 3000 * c.brown_pigments, 1e-9 * published);
  const double before = absorption_coefficient(p, 1450);
  p.absorption_tables = AbsorptionTables::prospect;
  EXPECT_NEAR(absorption_coefficient(p, 1450) - before, prospect_constants_at(1450).water - constants_at(1450).water,
              1e-9 * before);
}

TEST(TissueModel, DividesAbsorptionAndScalesTheCuticle) {
  TissueParams p = find_specimen("soybean")->params;
  const TissueModel published(p);
  EXPECT_EQ(published.at(550).optical_depth[4], 0);
  p.spongy_share = 0.3, p.cuticle_refractivity = 0.5;
  const TissueModel model(p);
  const Tissue tissue = model.at(550);
  const double depth = published.at(550).mesophyll_depth();
  EXPECT_NEAR(tissue.mesophyll_depth(), depth, 1e-12);
  EXPECT_NEAR(tissue.optical_depth[4], 0.3 * depth, 1e-12);
  EXPECT_NEAR(tissue.n_cuticle() - 1, 0.5 * (constants_at(550).n_cuticle - 1), 1e-12);
}

TEST(TissueModel, SumsAbsorptionOverWhatTheMesophyllHolds) {
  const TissueParams& p = find_specimen("soybean")->params;
  const Constants c = constants_at(455);
  const double mu =
      5.1388 * c.chlorophyll + 1.1323 * c.carotenoids + 78.7059 * c.protein + 48.5006 * c.cellulose + c.water;
  EXPECT_NEAR(absorption_coefficient(p, 455), mu, 1e-9 * mu);
  const TissueModel model(p);
  EXPECT_NEAR(model.at(455).optical_depth[2], mu * 0.5 * 1.66e-4, 1e-12);
}

TEST(TissueModel, FollowsTheConstantsAtEveryWavelength) {
  const TissueParams& p = find_specimen("maize")->params;
  const TissueModel model(p);
  for (double nm = 360; nm <= 2500; nm += 0.5) {
    const Tissue tissue = model.at(nm);
    ASSERT_NEAR(tissue.n_cuticle(), constants_at(nm).n_cuticle, 1e-12) << nm;
    ASSERT_NEAR(tissue.n[2], constants_at(nm).n_mesophyll, 1e-12) << nm;
    const double depth = absorption_coefficient(p, nm) * p.mesophyll_fraction * p.thickness_m;
    ASSERT_NEAR(tissue.optical_depth[4], depth, 1e-12 * (1 + depth)) << nm;
  }
}

}  // namespace
}  // namespace frond::leaf
