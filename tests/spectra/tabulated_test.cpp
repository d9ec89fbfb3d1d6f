#include "spectra/tabulated.h"

#include <gmock/gmock.h>

#include "spectra/analytic.h"
#include "spectra/cie.h"
#include "spectra/named.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using testing::HasSubstr;

const Location kTableHere{std::make_shared<const std::string>("scene.pbrt"), 3, 7};

std::string error_of_table(const std::vector<double>& pairs) {
  return error_of([&] { make_tabulated(pairs, kTableHere); });
}

TEST(Tabulated, IsLinearBetweenUnevenPoints) {
  const std::vector<SpectrumPoint> points{{400.5, 1}, {410.25, 3}, {700, 0}};
  const TabulatedSpectrum s(points);
  EXPECT_EQ(s.at(400.5f), 1);
  EXPECT_FLOAT_EQ(s.at(405.375f), 2);
  EXPECT_EQ(s.at(410.25f), 3);
  EXPECT_EQ(s.max_value(), 3);
}

TEST(Tabulated, HoldsTheNearestEndOutsideItsRange) {
  const auto s = make_tabulated(std::vector<double>{400, 1, 500, 2}, kTableHere);
  EXPECT_EQ(s->range_nm().min, 400);
  EXPECT_EQ(s->range_nm().max, 500);
  EXPECT_EQ(s->at(10), 1);
  EXPECT_EQ(s->at(400), 1);
  EXPECT_EQ(s->at(500), 2);
  EXPECT_EQ(s->at(5000), 2);
}

TEST(Tabulated, EveryMakeOfTheSameTableAgrees) {
  const std::vector<SpectrumPoint> points{{400, 1}, {403, 7}, {450, 2}, {700, 5}};
  const TabulatedSpectrum exact(points);
  const SpectrumPtr fast = make_tabulated(points);
  EXPECT_NE(dynamic_cast<const DenseSpectrum*>(fast.get()), nullptr);
  for (float nm = 380; nm < 720; nm += 0.37f) EXPECT_NEAR(fast->at(nm), exact.at(nm), 2e-5) << nm;
  EXPECT_EQ(fast->max_value(), exact.max_value());
}

TEST(Tabulated, FractionsOfANanometreAreKept) {
  const auto s = make_tabulated(std::vector<double>{400.5, 1, 400.75, 9, 401, 1}, kTableHere);
  EXPECT_EQ(s->at(400.75f), 9);
}

TEST(Tabulated, EqualValuesAreConstantWithinTheirRange) {
  const auto s = make_tabulated(std::vector<double>{360, 0.5, 2500, 0.5}, kTableHere);
  EXPECT_NE(dynamic_cast<const ConstantSpectrum*>(s.get()), nullptr);
  EXPECT_EQ(s->range_nm().max, 2500);
}

TEST(Tabulated, BadTablesAreRefusedWhereTheyStand) {
  EXPECT_EQ(error_of_table({400, 1, 390, 1}), "scene.pbrt:3:7: wavelengths must ascend, 390 nm follows 400 nm");
  EXPECT_THAT(error_of_table({400, 1, 400, 1}), HasSubstr("must ascend"));
  EXPECT_THAT(error_of_table({400, 1, 500, NAN}), HasSubstr("the value at 500 nm is nan"));
  EXPECT_THAT(error_of_table({400, 1, INFINITY, 1}), HasSubstr("inf is not a wavelength"));
  EXPECT_THAT(error_of_table({-4, 1, 500, 1}), HasSubstr("-4 is not a wavelength"));
  EXPECT_THAT(error_of_table({400, -0.1, 500, 1}), HasSubstr("cannot be negative"));
  EXPECT_THAT(error_of_table({400, 1, 500}), HasSubstr("pairs of wavelength and value, 3 numbers"));
  EXPECT_THAT(error_of_table({400, 1}), HasSubstr("two wavelengths at least, 1 given"));
  EXPECT_THAT(error_of_table({}), HasSubstr("two wavelengths at least, 0 given"));
}

TEST(Blackbody, PeaksAtOneWhereWienSays) {
  const BlackbodySpectrum s(5000);
  const float peak = 2.897771955e6f / 5000;
  EXPECT_FLOAT_EQ(s.at(peak), 1);
  EXPECT_LT(s.at(peak * 0.98f), 1);
  EXPECT_LT(s.at(peak * 1.02f), 1);
}

TEST(Blackbody, FollowsPlanckBeyondTheVisible) {
  // Ratio of two wavelengths by Planck's law, from the radiation constant c2 = 0.01438776877 m K.
  const BlackbodySpectrum s(2856);
  const auto planck = [](double um) { return std::pow(um, -5) / (std::exp(14387.76877 / (um * 2856)) - 1); };
  EXPECT_NEAR(double(s.at(2500)) / double(s.at(360)), planck(2.5) / planck(0.36), 1e-5 * planck(2.5) / planck(0.36));
  EXPECT_TRUE(s.range_nm().contains(2500));
}

TEST(Blackbody, ImpossibleTemperaturesAreRefused) {
  for (const double kelvin : {0.0, -5.0, double(NAN), double(INFINITY)})
    EXPECT_THAT(error_of([&] { BlackbodySpectrum s(kelvin, kTableHere); }), HasSubstr("scene.pbrt:3:7: a blackbody's"));
}

/// Integrals of ASTM G173-03 from 300 to 2500 nm, W/m^2: most of the solar constant, and most of what the standard
/// calls 1000.37 and 900.14 W/m^2 from 280 to 4000 nm.
TEST(Named, TheSunHasThePowerThatTheStandardSays) {
  const auto power = [](std::string_view name) {
    const SpectrumPtr s = named_spectrum(name, kTableHere);
    double sum = 0;
    for (int nm = 300; nm < 2500; ++nm) sum += (double(s->at(float(nm))) + double(s->at(float(nm + 1)))) / 2;
    return sum;
  };
  EXPECT_NEAR(power("solar-am1.5-global"), 992.6, 0.5);
  EXPECT_NEAR(power("solar-am1.5-direct"), 892.3, 0.5);
  EXPECT_NEAR(power("solar-am0"), 1307, 1);
  EXPECT_EQ(named_spectrum("solar-am0", kTableHere)->range_nm().max, 2500);
  EXPECT_NEAR(named_spectrum("solar-am1.5-direct", kTableHere)->at(2500), 0.0070328, 1e-7);
}

TEST(Named, IlluminantsAreThereAsPublishedAndOthersAreNamed) {
  for (const std::string_view name :
       {"stdillum-A", "stdillum-D50", "stdillum-D55", "stdillum-D65", "stdillum-D75", "stdillum-E", "illum-acesD60"})
    EXPECT_EQ(named_spectrum(name, kTableHere)->at(560), 100) << name;
  EXPECT_NE(named_spectrum("stdillum-A", kTableHere)->at(600), named_spectrum("stdillum-D65", kTableHere)->at(600));
  EXPECT_THAT(error_of([] { named_spectrum("stdilum-D65", kTableHere); }), HasSubstr("did you mean \"stdillum-D65\"?"));
}

/// Chromaticities that CIE 15:2004 publishes, tables T.3 and T.8, and of the white of ACES (SMPTE ST 2065-1).
TEST(Named, IlluminantsHaveTheirChromaticities) {
  const auto expect = [](std::string_view name, double x, double y, double tolerance) {
    const Triple xyz = to_xyz(*named_spectrum(name, kTableHere));
    const double sum = xyz[0] + xyz[1] + xyz[2];
    EXPECT_NEAR(xyz[0] / sum, x, tolerance) << name;
    EXPECT_NEAR(xyz[1] / sum, y, tolerance) << name;
  };
  expect("stdillum-D50", 0.34567, 0.35850, 1e-4);
  expect("stdillum-D55", 0.33242, 0.34743, 1e-4);
  expect("stdillum-D75", 0.29902, 0.31485, 1e-4);
  expect("illum-acesD60", 0.32168, 0.33767, 2e-4);
  constexpr double kFluorescent[][2] = {{0.3131, 0.3371}, {0.3721, 0.3751}, {0.4091, 0.3941}, {0.4402, 0.4031},
                                        {0.3138, 0.3452}, {0.3779, 0.3882}, {0.3129, 0.3292}, {0.3458, 0.3586},
                                        {0.3741, 0.3727}, {0.3458, 0.3588}, {0.3805, 0.3769}, {0.4370, 0.4042}};
  for (size_t i = 0; i < 12; ++i)
    expect("stdillum-F" + std::to_string(i + 1), kFluorescent[i][0], kFluorescent[i][1], 5e-4);
}

/// Catalogues' n_d, at the yellow line of helium, and Abbe numbers, which the line C and F decide.
TEST(Named, GlassesRefractAsCataloguesSay) {
  const auto expect = [](std::string_view name, double n_d, double abbe) {
    const SpectrumPtr n = named_spectrum(name, kTableHere);
    const auto at = [&](float nm) { return double(n->at(nm)); };
    EXPECT_NEAR(at(587.5618f), n_d, 2e-5) << name;
    EXPECT_NEAR((at(587.5618f) - 1) / (at(486.1327f) - at(656.2725f)), abbe, 0.02) << name;
  };
  expect("glass-BK7", 1.51680, 64.17);
  expect("glass-BAF10", 1.67003, 47.11);
  expect("glass-FK51A", 1.48656, 84.47);
  expect("glass-LASF9", 1.85025, 32.17);
  expect("glass-SF5", 1.67271, 32.25);
  expect("glass-SF10", 1.72828, 28.53);
  expect("glass-SF11", 1.78472, 25.68);
  for (const char* number : {"5", "10", "11"})
    EXPECT_EQ(named_spectrum(std::string("glass-F") + number, kTableHere),
              named_spectrum(std::string("glass-SF") + number, kTableHere));
}

/// Reflectance at normal incidence, ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2): gold is dark in the blue, silver nowhere.
TEST(Named, MetalsHaveTheirColours) {
  const auto reflectance = [](const std::string& metal, float nm) {
    const double n = double(named_spectrum("metal-" + metal + "-eta", kTableHere)->at(nm));
    const double k = double(named_spectrum("metal-" + metal + "-k", kTableHere)->at(nm));
    return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
  };
  EXPECT_NEAR(reflectance("Au", 450), 0.39, 0.02);
  EXPECT_NEAR(reflectance("Au", 700), 0.97, 0.02);
  EXPECT_NEAR(reflectance("Cu", 450), 0.55, 0.04);
  EXPECT_NEAR(reflectance("Cu", 700), 0.96, 0.03);
  EXPECT_NEAR(reflectance("Al", 550), 0.92, 0.02);
  EXPECT_GT(reflectance("Ag", 450), 0.9);
  EXPECT_GT(reflectance("CuZn", 650), reflectance("CuZn", 450));
  EXPECT_EQ(named_spectrum("metal-MgO-k", kTableHere)->at(550), 0);
  EXPECT_NEAR(double(named_spectrum("metal-TiO2-eta", kTableHere)->at(600)), 2.9, 0.2);
}

TEST(Named, AllReachOverTheVisible) {
  for (const std::string_view name : spectrum_names()) {
    const Interval range = named_spectrum(name, kTableHere)->range_nm();
    EXPECT_LE(range.min, kCieRange_nm.min) << name;
    EXPECT_GE(range.max, kCieRange_nm.max) << name;
  }
}

}  // namespace
}  // namespace frond
