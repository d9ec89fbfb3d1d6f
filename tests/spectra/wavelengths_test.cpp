#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/math/random.h"
#include "spectra/analytic.h"
#include "spectra/check_range.h"
#include "spectra/cie.h"
#include "spectra/color/color_space.h"
#include "spectra/named.h"
#include "spectra/wavelengths/registry.h"
#include "tests/support/bind.h"
#include "tests/support/input_error.h"
#include "tests/support/parsed_params.h"

namespace frond {
namespace {

using ::testing::HasSubstr;

std::unique_ptr<WavelengthStrategy> make(std::string_view name, const std::vector<ParsedParam>& params = {}) {
  const PluginTable<WavelengthsInfo> table("wavelengths", builtin_wavelengths());
  const WavelengthsInfo& info = table.get(name, {});
  return test::make_plugin(info, params);
}

std::unique_ptr<WavelengthStrategy> make_hero(double min_nm, double max_nm) {
  return make("hero", {test::number("float", "lambdamin", {min_nm}), test::number("float", "lambdamax", {max_nm})});
}

TEST(Smpte, WhiteUnderD65IsWhite) {
  const auto smpte = make("smpte");
  const SampledWavelengths lambda = smpte->sample(0.3f);
  const Triple rgb = smpte->sensor(unit_d65()->sample(lambda), lambda).color();
  for (const double c : rgb) EXPECT_DOUBLE_EQ(c, 1);
}

TEST(Smpte, CarriesThePapersThreeWavelengths) {
  const auto smpte = make("smpte");
  const SampledWavelengths lambda = smpte->sample(0.9f);
  EXPECT_EQ(lambda.count, 3);
  EXPECT_THAT(lambda.nm, ::testing::ElementsAre(608, 551, 455, 0));
  EXPECT_THAT(lambda.pdf, ::testing::ElementsAre(1, 1, 1, 0));
  EXPECT_THAT(lambda.active, ::testing::ElementsAre(true, true, true, false));
  EXPECT_THAT(smpte->fixed_nm(), ::testing::ElementsAre(608, 551, 455));
  EXPECT_THAT(smpte->luminance_shares(), ::testing::ElementsAre(0.21222f, 0.7013f, 0.0865f));
  EXPECT_EQ(smpte->film_space(), "linear SMPTE-C");
  EXPECT_NE(find_color_space(smpte->film_space()), nullptr);
}

TEST(Smpte, TakesOtherWavelengthsInWhichWhiteIsWhiteToo) {
  const auto smpte = make("smpte", {test::number("float", "blue", {464.7}), test::number("float", "red", {400})});
  const SampledWavelengths lambda = smpte->sample(0);
  EXPECT_THAT(smpte->fixed_nm(), ::testing::ElementsAre(400, 551, 464.7f));
  EXPECT_EQ(smpte->range_nm().min, 400);
  EXPECT_EQ(smpte->range_nm().max, 551);
  for (const double c : smpte->sensor(unit_d65()->sample(lambda), lambda).color()) EXPECT_DOUBLE_EQ(c, 1);
}

TEST(Hero, DensityIsTheKnownOneOverTheVisible) {
  const auto hero = make("hero");
  for (const float u : {0.f, 0.1f, 0.2499f}) {
    const SampledWavelengths lambda = hero->sample(u);
    for (size_t i = 0; i < kLanes; ++i) {
      const double c = std::cosh(0.0072 * (double(lambda.nm[i]) - 538));
      EXPECT_NEAR(double(lambda.pdf[i]), 0.0039398042 / (c * c), 1e-9);
    }
  }
}

TEST(Hero, DensityIntegratesToOneAndMatchesItsSamples) {
  for (const auto& [min, max] : {Interval{360, 830}, Interval{400, 700}, Interval{360, 2500}, Interval{900, 2500}}) {
    const auto hero = make_hero(min, max);
    // First lanes of evenly spaced u, in order: a Riemann sum of the density over them is its integral.
    constexpr int kCount = 1 << 14;
    std::map<float, float> density;
    for (int k = 0; k < kCount; ++k) {
      const SampledWavelengths lambda = hero->sample((float(k) + 0.5f) / kCount);
      ASSERT_TRUE(hero->range_nm().contains(double(lambda.nm[0])));
      density[lambda.nm[0]] = lambda.pdf[0];
    }
    double previous = min, integral = 0;
    for (const auto& [nm, pdf] : density) integral += double(pdf) * (double(nm) - std::exchange(previous, double(nm)));
    EXPECT_NEAR(integral, 1, 3e-3) << min << " to " << max;
    EXPECT_NEAR(double(hero->sample(0).nm[0]), min, 1e-3);
  }
}

/// n paths have 4n wavelengths, one in each of 4n equal intervals of the density's integral; their first lanes are in n
/// equal intervals.
TEST(Hero, FewPathsCoverTheSpectrum) {
  const auto hero = make("hero");
  const auto reduced = [](double nm) { return std::tanh(0.0072 * (nm - 538)); };
  const auto below = [&](float nm) { return (reduced(double(nm)) - reduced(360)) / (reduced(830) - reduced(360)); };
  for (const int n : {1, 4, 16, 64, 256}) {
    std::set<int> cells, first;
    for (int i = 0; i < n; ++i) {
      const SampledWavelengths lambda = hero->sample((float(i) + 0.5f) / float(n));
      EXPECT_EQ(lambda.count, 4);
      for (const float nm : lambda.nm) cells.insert(int(below(nm) * 4 * n));
      first.insert(int(below(lambda.nm[0]) * n));
    }
    EXPECT_EQ(cells.size(), size_t(4 * n));
    EXPECT_EQ(first.size(), size_t(n));
  }
  EXPECT_TRUE(hero->fixed_nm().empty());
}

/// Mean of the sensor's answers to `s`, and the error of that mean.
struct Estimated {
  Triple mean{}, standard_error{};
};
Estimated estimate(const WavelengthStrategy& strategy, const Spectrum& s, int n) {
  RandomStream rng(hash_key(7));
  Triple sum{}, square{};
  for (int k = 0; k < n; ++k) {
    const SampledWavelengths lambda = strategy.sample(rng.uniform());
    const Triple xyz = strategy.sensor(s.sample(lambda), lambda).color();
    for (size_t c = 0; c < 3; ++c) sum[c] += xyz[c], square[c] += xyz[c] * xyz[c];
  }
  Estimated e;
  for (size_t c = 0; c < 3; ++c) {
    e.mean[c] = sum[c] / n;
    e.standard_error[c] = std::sqrt((square[c] / n - e.mean[c] * e.mean[c]) / n);
  }
  return e;
}

/// 5 standard errors in each of 3 channels: one false alarm in 580,000 runs; the seed is fixed.
void expect_xyz(const WavelengthStrategy& strategy, const Spectrum& s) {
  const Estimated e = estimate(strategy, s, 200000);
  const Triple exact = to_xyz(s);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(e.mean[c], exact[c], 5 * e.standard_error[c]) << c;
    EXPECT_GT(e.standard_error[c], 0) << c;
  }
}

/// Samples whose u are in n intervals have 4n wavelengths in as many intervals.
TEST(Hero, UniformSamplesCoverTheRangeEvenly) {
  const auto hero = make("hero", {test::number("float", "lambdamin", {400}), test::number("float", "lambdamax", {2400}),
                                  test::flag("uniform", true)});
  std::array<int, 20> counts{};
  for (int i = 0; i < 5; ++i) {
    const SampledWavelengths lambda = hero->sample_for_index(0, (float(i) + 0.3f) / 5);
    for (size_t lane = 0; lane < kLanes; ++lane) {
      EXPECT_FLOAT_EQ(lambda.pdf[lane], 1 / 2000.f);
      ++counts[size_t((lambda.nm[lane] - 400) / 100)];
    }
  }
  EXPECT_THAT(counts, ::testing::Each(1));
}

TEST(Hero, EstimatesTheColorOfD65) { expect_xyz(*make("hero"), *unit_d65()); }
TEST(Hero, EstimatesTheSameColorFromUniformSamples) {
  expect_xyz(*make("hero", {test::flag("uniform", true)}), *unit_d65());
}
TEST(Hero, EstimatesTheSameColorFromAWiderRange) {
  // Blackbody light beyond 830 nm must add nothing.
  const auto warm = unit_luminance(std::make_shared<BlackbodySpectrum>(2856));
  expect_xyz(*make_hero(360, 1200), *warm);
  expect_xyz(*make_hero(360, 2500), *warm);
}

TEST(Hero, LightOfUnitLuminanceHasYOne) {
  for (const double kelvin : {2856.0, 6500.0}) {
    const auto s = unit_luminance(std::make_shared<BlackbodySpectrum>(kelvin));
    const Estimated e = estimate(*make("hero"), *s, 200000);
    EXPECT_NEAR(e.mean[1], 1, 5 * e.standard_error[1]);  // one false alarm in 1.7 million runs
  }
}

TEST(Hero, RangesThatAreNoneAreRefused) {
  EXPECT_EQ(error_of([] { make_hero(700, 700); }), "\"lambdamax\" is 700 nm, above \"lambdamin\", 700 nm, is needed");
  EXPECT_THAT(error_of([] { make_hero(10, 700); }), HasSubstr("\"lambdamin\" is 10, outside its range 300 to 2500 nm"));
}

TEST(CheckRange, DataThatEndTooSoonAreNamed) {
  const Location here{std::make_shared<const std::string>("a.pbrt"), 4, 2};
  const auto hero = make_hero(360, 1000);
  EXPECT_EQ(error_of([&] { check_range(*d65(), *hero, here, "L"); }),
            "a.pbrt:4:2: \"L\" is known from 360 to 830 nm, the render needs 360 to 1000 nm");
  EXPECT_EQ(error_of([&] { check_range(BlackbodySpectrum(3000), *hero, here, "L"); }), "");
  EXPECT_EQ(error_of([&] { check_range({400, 700}, *make("smpte"), here, "reflectance"); }), "");
  EXPECT_THAT(error_of([&] {
                check_range({460, 700}, *make("smpte"), here, "reflectance");
              }),
              HasSubstr("needs 455 to 608"));
}

TEST(CheckRange, LightsThatEndTooSoonAreToldWhatReachesFurther) {
  const auto needs_850 = make_hero(450, 850);
  const auto message = [&](const SpectrumPtr& s) {
    return error_of([&] { check_light_range(*s, *needs_850, {}, "I"); });
  };
  EXPECT_EQ(message(d65()),
            "\"I\" is known from 360 to 830 nm, the render needs 450 to 850 nm; what reaches further: \"blackbody I\" "
            "5800, \"spectrum I\" \"stdillum-E\" or an .spd file");
  EXPECT_THAT(message(named_spectrum("stdillum-A", {})), HasSubstr("is known from 300 to 830 nm"));
  EXPECT_EQ(message(named_spectrum("stdillum-E", {})), "");
  EXPECT_EQ(message(std::make_shared<BlackbodySpectrum>(5800)), "");
}

TEST(Registry, EveryStrategyReadsWhatItDeclaresAndSaysWhereItComesFrom) {
  test::NoLookups resolver;
  for (const WavelengthsInfo* info : builtin_wavelengths()) {
    const Params params(*info, {std::string(info->name), {}, {}}, resolver);
    info->make(params);
    EXPECT_THAT(params.unread(), ::testing::IsEmpty()) << info->name;
    EXPECT_FALSE(info->source.empty());
    EXPECT_FALSE(info->doc.empty());
  }
}

}  // namespace
}  // namespace frond
