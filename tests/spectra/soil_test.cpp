#include "spectra/soil.h"

#include <gtest/gtest.h>

#include "spectra/tabulated.h"

namespace frond {
namespace {

TEST(Soil, VectorsGiveTheReflectancesOfNineSoils) {
  // Jiang and Fang 2019, table 3, evaluated with the published vectors.
  struct Check {
    std::string_view soil;
    double at[5];
  };
  constexpr float kLambda_nm[] = {450, 670, 860, 1650, 2200};
  constexpr Check kChecks[] = {
      {"wet_clay", {0.06522, 0.11065, 0.14231, 0.16254, 0.12654}},
      {"median_humid_clay", {0.24932, 0.34065, 0.39697, 0.44203, 0.41573}},
      {"dry_clay", {0.25486, 0.36961, 0.41764, 0.48002, 0.45677}},
      {"wet_sand", {0.16943, 0.25686, 0.31514, 0.28540, 0.17800}},
      {"median_humid_sand", {0.18663, 0.34832, 0.40665, 0.46880, 0.37367}},
      {"dry_sand", {0.25760, 0.46335, 0.52048, 0.60770, 0.51615}},
      {"wet_peat", {-0.00116, 0.03835, 0.11778, 0.16810, 0.09335}},
      {"median_humid_peat", {0.01667, 0.12960, 0.27280, 0.46300, 0.37546}},
      {"dry_peat", {-0.00394, 0.09829, 0.21559, 0.40847, 0.35211}},
  };
  for (const Check& check : kChecks) {
    const auto named = std::ranges::find(kSoils, check.soil, &NamedSoil::name);
    ASSERT_NE(named, std::end(kSoils)) << check.soil;
    const Soil soil(named->coefficients);
    for (size_t i = 0; i < std::size(kLambda_nm); ++i)
      EXPECT_NEAR(soil.reflectance(kLambda_nm[i], 0), std::max(check.at[i], 0.), 1e-5) << check.soil << kLambda_nm[i];
  }
}

TEST(Soil, FilmsDarkenAsInBsm) {
  // Figures of SCOPE's BSM for one soil, dry and with 15, 25 and 45 % of water.
  struct Check {
    double lambda_nm, dry, at_15, at_25, at_45;
  };
  constexpr Check kChecks[] = {
      {450, 0.097915, 0.088844, 0.082762, 0.075861},  {550, 0.148071, 0.131287, 0.120035, 0.107310},
      {670, 0.207643, 0.182607, 0.165820, 0.146849},  {860, 0.256903, 0.225767, 0.204864, 0.181176},
      {1000, 0.274653, 0.240814, 0.217854, 0.191214}, {1300, 0.304508, 0.265469, 0.238337, 0.205273},
      {1450, 0.309587, 0.233063, 0.177611, 0.107528}, {1660, 0.322216, 0.272122, 0.235238, 0.185869},
      {1860, 0.327269, 0.262963, 0.214824, 0.149898}, {1940, 0.303803, 0.210507, 0.147655, 0.076760},
      {2200, 0.320227, 0.252126, 0.201310, 0.133565}, {2400, 0.319946, 0.231620, 0.169176, 0.093511},
  };
  std::vector<SpectrumPoint> dry;
  for (const Check& c : kChecks) dry.push_back({c.lambda_nm, c.dry});
  const Soil soil(*make_tabulated(dry));
  for (const Check& c : kChecks) {
    const auto at = [&](float moisture) { return double(soil.reflectance(float(c.lambda_nm), moisture)); };
    EXPECT_NEAR(at(5), c.dry, 1e-6) << c.lambda_nm;
    EXPECT_NEAR(at(15), c.at_15, 1e-3) << c.lambda_nm;
    EXPECT_NEAR(at(25), c.at_25, 1e-3) << c.lambda_nm;
    EXPECT_NEAR(at(45), c.at_45, 1e-3) << c.lambda_nm;
  }
}

TEST(Soil, ReflectanceIsBoundedForAnyMoisture) {
  for (const NamedSoil& named : kSoils) {
    const Soil soil(named.coefficients);
    for (float nm = 300; nm <= 2500; nm += 7)
      for (const float moisture : {0.f, 5.f, 5.001f, 20.f, 55.f, 100.f}) {
        const float r = soil.reflectance(nm, moisture);
        EXPECT_GE(r, 0) << named.name << nm;
        EXPECT_LE(r, soil.max_reflectance()) << named.name << nm;
      }
    EXPECT_EQ(soil.reflectance(300, 30), soil.reflectance(400, 30));
    EXPECT_NEAR(soil.reflectance(1000, 5), soil.reflectance(1000, 5.01f), 1e-3) << "the films begin without a step";
  }
}

TEST(Soil, AWhiteSoilUnderClearWaterLosesNothing) {
  // Without absorption nothing is lost between soil and water, whatever the interfaces reflect.
  const Soil soil(*make_tabulated(std::vector<SpectrumPoint>{{400, 1}, {2500, 1}}));
  // Films of 0.15 mm absorb less than 1e-4 of the light up to 600 nm; with six films at most, Poisson's tail is
  // missing.
  EXPECT_NEAR(soil.reflectance(450, 15), 1, 2e-3);
  EXPECT_LT(soil.reflectance(1940, 15), 0.9f);
}

}  // namespace
}  // namespace frond
