#include "spectra/tabulated.h"

#include <gmock/gmock.h>

#include "spectra/analytic.h"
#include "spectra/named.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using testing::HasSubstr;

const Location kHere{std::make_shared<const std::string>("scene.pbrt"), 3, 7};

std::string error_of_table(const std::vector<double>& pairs) {
  return error_of([&] { make_tabulated(pairs, kHere); });
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
  const auto s = make_tabulated(std::vector<double>{400, 1, 500, 2}, kHere);
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
  const auto s = make_tabulated(std::vector<double>{400.5, 1, 400.75, 9, 401, 1}, kHere);
  EXPECT_EQ(s->at(400.75f), 9);
}

TEST(Tabulated, EqualValuesAreConstantWithinTheirRange) {
  const auto s = make_tabulated(std::vector<double>{360, 0.5, 2500, 0.5}, kHere);
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
    EXPECT_THAT(error_of([&] { BlackbodySpectrum s(kelvin, kHere); }), HasSubstr("scene.pbrt:3:7: a blackbody's"));
}

/// Integrals of ASTM G173-03 from 300 to 2500 nm, W/m^2: most of the solar constant, and most of what the standard
/// calls 1000.37 and 900.14 W/m^2 from 280 to 4000 nm.
TEST(Named, TheSunHasThePowerThatTheStandardSays) {
  const auto power = [](std::string_view name) {
    const SpectrumPtr s = named_spectrum(name, kHere);
    double sum = 0;
    for (int nm = 300; nm < 2500; ++nm) sum += (double(s->at(float(nm))) + double(s->at(float(nm + 1)))) / 2;
    return sum;
  };
  EXPECT_NEAR(power("solar-am1.5-global"), 992.6, 0.5);
  EXPECT_NEAR(power("solar-am1.5-direct"), 892.3, 0.5);
  EXPECT_NEAR(power("solar-am0"), 1307, 1);
  EXPECT_EQ(named_spectrum("solar-am0", kHere)->range_nm().max, 2500);
  EXPECT_NEAR(named_spectrum("solar-am1.5-direct", kHere)->at(2500), 0.0070328, 1e-7);
}

TEST(Named, IlluminantsAreThereAsPublishedAndOthersAreNamed) {
  for (const std::string_view name : {"stdillum-A", "stdillum-D65", "stdillum-E"})
    EXPECT_EQ(named_spectrum(name, kHere)->at(560), 100) << name;
  EXPECT_NE(named_spectrum("stdillum-A", kHere)->at(600), named_spectrum("stdillum-D65", kHere)->at(600));
  EXPECT_EQ(error_of([] { named_spectrum("metal-Cu-eta", kHere); }),
            "scene.pbrt:3:7: pbrt-v4's spectrum \"metal-Cu-eta\" is not available; what there is: solar-am0, "
            "solar-am1.5-direct, solar-am1.5-global, stdillum-A, stdillum-D65, stdillum-E, or a .spd file");
  EXPECT_THAT(error_of([] { named_spectrum("stdilum-D65", kHere); }), HasSubstr("did you mean \"stdillum-D65\"?"));
}

}  // namespace
}  // namespace frond
