#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <set>

#include "core/math/random.h"
#include "spectra/analytic.h"
#include "spectra/cie.h"
#include "spectra/tabulated.h"
#include "spectra/wavelengths/band_preview.h"
#include "spectra/wavelengths/registry.h"
#include "spectra/wavelengths/response_sampler.h"
#include "tests/support/bind.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using test::number;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

/// Finds files under their own name.
class OnlyFiles final : public ParamResolver {
 public:
  std::shared_ptr<const FloatTexture> float_texture(const std::string&, const Location& w) override { none(w); }
  std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string&, const Location& w) override { none(w); }
  std::shared_ptr<Material> material(const std::string&, const Location& w) override { none(w); }
  SpectrumPtr spectrum(const ParsedParam& p, SpectrumUse) override { none(p.where); }
  fs::path file(const std::string& name, const Location&) override { return name; }

 private:
  [[noreturn]] static void none(const Location& where) { fail(where, "this test resolves files alone"); }
};

std::unique_ptr<WavelengthStrategy> make_bands(std::vector<ParsedParam> params) {
  OnlyFiles resolver;
  const WavelengthsInfo& info = PluginTable<WavelengthsInfo>("wavelengths", builtin_wavelengths()).get("bands", {});
  return info.make(Params(info, {"bands", {}, std::move(params)}, resolver));
}

std::unique_ptr<WavelengthStrategy> at(std::vector<double> nm) {
  return make_bands({number("float", "wavelengths", std::move(nm))});
}

std::vector<double> wavelengths_of(const WavelengthStrategy& strategy) {
  std::vector<double> nm;
  for (const Band& band : strategy.bands()) nm.push_back(band.nm);
  return nm;
}

TEST(Bands, AreTheWavelengthsInTheOrderInWhichTheyAreAskedFor) {
  EXPECT_THAT(wavelengths_of(*at({850, 450, 2200})), ElementsAre(850, 450, 2200));
  EXPECT_THAT(at({850, 450, 2200})->fixed_nm(), ElementsAre(850, 450, 2200));
  EXPECT_THAT(at({850, 450, 2200})->listed_nm(), ElementsAre(450, 850, 2200));
  EXPECT_THAT(wavelengths_of(*make_bands({number("float", "lambdamin", {450}), number("float", "lambdamax", {475}),
                                          number("float", "step", {12.5})})),
              ElementsAre(450, 462.5, 475));
  EXPECT_EQ(make_bands({})->bands().size(), 31u);
  EXPECT_EQ(at({850, 450})->range_nm().min, 450);
  EXPECT_EQ(at({850, 450})->range_nm().max, 850);
}

TEST(Bands, WhatContradictsItselfIsRefused) {
  EXPECT_THAT(error_of([] { at({500, 500}); }), HasSubstr("two bands at 500 nm"));
  EXPECT_THAT(error_of([] { at({2600}); }), HasSubstr("outside its range 300 to 2500 nm"));
  EXPECT_THAT(error_of([] {
                make_bands({number("float", "wavelengths", {500}), number("float", "step", {5})});
              }),
              HasSubstr("\"step\" is for evenly spaced wavelengths"));
  EXPECT_THAT(error_of([] { make_bands({number("float", "lambdamin", {800})}); }), HasSubstr("below \"lambdamin\""));
}

TEST(Bands, FourAtMostAreTheSameForEveryPath) {
  const auto bands = at({450, 550, 650, 850});
  EXPECT_THAT(bands->fixed_nm(), ElementsAre(450, 550, 650, 850));
  for (const uint64_t index : {0u, 1u, 7u})
    EXPECT_THAT(bands->sample_for_index(index, 0.7f).nm, ElementsAre(450, 550, 650, 850));
  EXPECT_TRUE(at({450, 550, 650, 750, 850})->fixed_nm().empty());
  EXPECT_EQ(at({450, 550, 650, 750, 850})->listed_nm().size(), 5u);
}

TEST(Bands, MoreAreDealtOutInTurn) {
  for (const size_t count : {5u, 6u, 7u, 8u, 31u}) {
    std::vector<double> nm;
    for (size_t i = 0; i < count; ++i) nm.push_back(400 + 10 * double(i));
    const auto bands = at(nm);
    std::vector<int> seen(count);
    for (uint64_t index = 0; index < count; ++index) {
      const SampledWavelengths lambda = bands->sample_for_index(index, 0.3f);
      ASSERT_EQ(lambda.count, 4);
      for (size_t lane = 0; lane < 4; ++lane) {
        ++seen[lambda.band[lane]];
        EXPECT_EQ(double(lambda.nm[lane]), nm[lambda.band[lane]]);
      }
    }
    EXPECT_THAT(seen, ::testing::Each(4)) << count;
  }
}

TEST(Bands, AreAllSeenByAQuarterAsManySamples) {
  for (const size_t count : {5u, 6u, 7u, 8u, 9u, 31u}) {
    std::vector<double> nm;
    for (size_t i = 0; i < count; ++i) nm.push_back(400 + 10 * double(i));
    const auto bands = at(nm);
    for (const uint64_t first : {0u, 3u, 17u}) {
      std::set<uint16_t> seen;
      for (uint64_t i = 0; i < (count + 3) / 4; ++i)
        for (const uint16_t band : bands->sample_for_index(first + i, 0).band) seen.insert(band);
      EXPECT_EQ(seen.size(), count) << first;
    }
  }
}

TEST(Bands, ByChanceEveryBandIsAsLikely) {
  for (const size_t count : {5u, 6u, 8u}) {
    std::vector<double> nm;
    for (size_t i = 0; i < count; ++i) nm.push_back(400 + 10 * double(i));
    const auto bands = at(nm);
    std::vector<int> seen(count);
    for (size_t i = 0; i < 10 * count; ++i)
      for (const uint16_t band : bands->sample((static_cast<float>(i) + 0.5f) / (10 * static_cast<float>(count))).band)
        ++seen[band];
    EXPECT_THAT(seen, ::testing::Each(40)) << count;
  }
}

TEST(Bands, LanesFeedTheirOwnChannels) {
  const auto bands = at({400, 500, 600, 700, 800, 900});
  const SampledWavelengths lambda = bands->sample_for_index(1, 0);
  SampledSpectrum radiance;
  for (int i = 0; i < 4; ++i) radiance[i] = float(i + 1);
  const SensorResponse r = bands->sensor(radiance, lambda);
  EXPECT_EQ(r.count, 4);
  EXPECT_THAT(r.channel, ElementsAre(1, 2, 4, 5));
  EXPECT_THAT(r.value, ElementsAre(1, 2, 3, 4));
}

class Responses : public ::testing::Test {
 protected:
  Responses() : folder_(fs::temp_directory_path() / fmt::format("frond_bands_{}", getpid())) {
    fs::create_directory(folder_);
  }
  ~Responses() override { fs::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  static std::unique_ptr<WavelengthStrategy> make(std::vector<std::string> files, std::vector<std::string> names = {}) {
    std::vector<ParsedParam> params{{"string", "responses", {}, {}, std::move(files)}};
    if (!names.empty()) params.push_back({"string", "names", {}, {}, std::move(names)});
    return make_bands(std::move(params));
  }

  fs::path folder_;
};

TEST_F(Responses, AreSampledWithinTheirSupport) {
  const auto bands = make({write("a.spd", "300 0  500 0  510 1  530 1  550 0  2000 0")});
  ASSERT_EQ(bands->bands().size(), 1u);
  EXPECT_TRUE(bands->fixed_nm().empty());
  EXPECT_TRUE(bands->listed_nm().empty());
  EXPECT_EQ(bands->range_nm().min, 500);
  EXPECT_EQ(bands->range_nm().max, 550);
  EXPECT_NEAR(bands->bands()[0].nm, 18300.0 / 35, 1e-9);  // of a trapezium
  for (float u = 0; u < 1; u += 0.01f)
    EXPECT_TRUE(bands->range_nm().contains(double(bands->sample_for_index(0, u).nm[0])));
}

/// By the midpoints of many steps between the response's points.
template <class Function>
double midpoint_mean(const std::vector<ResponsePoint>& response, const Function& f) {
  constexpr int kSteps = 1000;
  double weighted = 0, area = 0;
  for (size_t i = 1; i < response.size(); ++i)
    for (int k = 0; k < kSteps; ++k) {
      const double t = (k + 0.5) / kSteps;
      const double s = std::lerp(response[i - 1].value, response[i].value, t) * (response[i].nm - response[i - 1].nm);
      weighted += s * f(std::lerp(response[i - 1].nm, response[i].nm, t));
      area += s;
    }
  return weighted / area;
}

/// Tables of sensors often cover a wide range and are 0 in most of it.
TEST_F(Responses, ArePaddedWithAnyNumberOfZeros) {
  std::string box;  // 5 nm at steps of 1
  for (int nm = 400; nm <= 1000; ++nm) box += fmt::format("{} {}\n", nm, nm >= 701 && nm <= 704 ? 1 : 0);
  struct Case {
    std::string text;
    std::vector<ResponsePoint> points;
  };
  const std::vector<Case> cases{{box, {{700, 0}, {701, 1}, {702, 1}, {703, 1}, {704, 1}, {705, 0}}},
                                {"300 0  549 0  550 2  551 0  2500 0", {{549, 0}, {550, 2}, {551, 0}}},
                                {"300 0  500 0  510 1  600 0  800 0  801 0.1  802 0  2000 0",
                                 {{500, 0}, {510, 1}, {600, 0}, {800, 0}, {801, 0.1}, {802, 0}}},
                                {"400 3  401 0  900 0", {{400, 3}, {401, 0}}},
                                {"400 0  899 0  900 3", {{899, 0}, {900, 3}}}};
  constexpr int kSamples = 1 << 16;
  for (const Case& c : cases) {
    const auto bands = make({write("padded.spd", c.text)});
    const Band& band = bands->bands()[0];
    EXPECT_EQ(band.response, c.points);
    const double width = c.points.back().nm - c.points.front().nm;
    double first = 0, second = 0;
    for (int i = 0; i < kSamples; ++i) {
      const SampledWavelengths lambda = bands->sample_for_index(0, (float(i) + 0.5f) / kSamples);
      EXPECT_EQ(bands->sensor(SampledSpectrum(1), lambda).value[0], 1);  // equal energy
      EXPECT_TRUE(bands->range_nm().contains(double(lambda.nm[0])));
      const double x = (double(lambda.nm[0]) - c.points.front().nm) / width;
      first += x, second += x * x;
    }
    const auto mean = [&](int power) {
      return midpoint_mean(c.points, [&](double nm) { return std::pow((nm - c.points.front().nm) / width, power); });
    };
    // x and its square rise with u, from 0 to 1: the mean of their midpoints is off by half a step at most. To this are
    // added half a float's spacing of the wavelength and the error of midpoint_mean's steps.
    const double rounding = 6.2e-5 / width + 1e-6;
    EXPECT_NEAR(first / kSamples, mean(1), 0.5 / kSamples + rounding) << c.text.substr(0, 60);
    EXPECT_NEAR(second / kSamples, mean(2), 0.5 / kSamples + 2 * rounding) << c.text.substr(0, 60);
    EXPECT_NEAR(band.nm, c.points.front().nm + width * mean(1), 1e-6 * width);
  }
}

/// Mean response of each band to a spectrum, over evenly spaced u, and its exact value.
TEST_F(Responses, FindTheMeanRadianceUnderEachResponse) {
  const auto bands =
      make({write("a.spd", "400 0  450 1  500 0"), write("b.spd", "420 0.2  700 0.9"), write("c.spd", "600 1  601 1"),
            write("d.spd", "500 0 800 1 801 0"), write("e.spd", "650.25 0 650.5 1 650.75 0 900 0")});
  ASSERT_EQ(bands->bands().size(), 5u);
  const auto light = std::make_shared<BlackbodySpectrum>(3000);
  constexpr int kSamples = 20000;
  std::vector<double> sum(5), count(5);
  for (int i = 0; i < kSamples; ++i) {
    // Golden steps, so that the index of the sample and u are independent.
    const float u = static_cast<float>(std::fmod(i * 0.6180339887498949, 1));
    const SampledWavelengths lambda = bands->sample_for_index(uint64_t(i), u);
    const SensorResponse r = bands->sensor(light->sample(lambda), lambda);
    for (size_t k = 0; k < size_t(r.count); ++k) sum[r.channel[k]] += r.value[k], ++count[r.channel[k]];
  }
  for (size_t b = 0; b < 5; ++b) {
    const Band& band = bands->bands()[b];
    EXPECT_EQ(count[b], kSamples * 4 / 5);
    EXPECT_NEAR(
        sum[b] / count[b] / midpoint_mean(band.response, [&](double nm) { return double(light->at(float(nm))); }), 1,
        2e-3)
        << band.nm;
  }
}

TEST_F(Responses, ThatAreNothingAreRefused) {
  EXPECT_THAT(error_of([&] { make({write("a.spd", "400 0  500 0")}); }), HasSubstr("0 at every wavelength"));
  EXPECT_THAT(error_of([&] { make({(folder_ / "none.spd").string()}); }), HasSubstr("cannot read spectrum file"));
}

/// Bands with equal mean wavelengths, neither in alphabetical order nor in the order of wavelengths.
TEST_F(Responses, HaveTheNamesOfTheirFilesAndKeepTheirOrder) {
  const std::vector<std::string> files{write("par.spd", "400 1 700 1"), write("green.spd", "540 1 560 1"),
                                       write("blue.spd", "450 1 460 1")};
  const auto names_of = [](const WavelengthStrategy& strategy) {
    std::vector<std::string> names;
    for (const Band& band : strategy.bands()) names.push_back(band.name);
    return names;
  };
  const auto bands = make(files);
  EXPECT_THAT(names_of(*bands), ElementsAre("par", "green", "blue"));
  EXPECT_THAT(wavelengths_of(*bands), ElementsAre(550, 550, 455));
  EXPECT_EQ(bands->range_nm().min, 400);
  EXPECT_EQ(bands->range_nm().max, 700);
  EXPECT_THAT(names_of(*make(files, {"PAR", "G", "B"})), ElementsAre("PAR", "G", "B"));
  EXPECT_EQ(at({550})->bands()[0].name, "");
}

/// A table of a whole sensor, with a thermal band and one that the sensor lacks.
TEST_F(Responses, AreAllBandsOfATable) {
  const std::string table =
      write("s.csv", "wl,B1,B2,B3,B10\n500,1,0,0,0\n600,1,0,0,0\n700,0,1,0,0\n710,0,0,0,0\n11000,0,0,0,1\n");
  const auto names_of = [](const WavelengthStrategy& strategy) {
    std::vector<std::string> names;
    for (const Band& band : strategy.bands()) names.push_back(band.name);
    return names;
  };
  const std::string green = write("green.csv", "wl,x\n540,1\n560,1\n");
  EXPECT_THAT(names_of(*make({table})), ElementsAre("B1", "B2"));
  EXPECT_THAT(names_of(*make({green, table}, {"g", "a", "b"})), ElementsAre("g", "a", "b"));
  EXPECT_THAT(names_of(*make({table + ":B2", green})), ElementsAre("B2", "green"));
  EXPECT_THAT(error_of([&] { make({table + ":B3"}); }), HasSubstr("0 at every wavelength"));
}

TEST_F(Responses, NeedNamesThatTellThemApart) {
  const std::string file = write("nir.spd", "800 1 900 1");
  const auto error = [&](std::vector<std::string> names) {
    return error_of([&] { make({file, file}, std::move(names)); });
  };
  EXPECT_THAT(error({}), HasSubstr("two bands are named \"nir\": \"names\" gives each band a name of its own"));
  EXPECT_THAT(error({"a", "a"}), HasSubstr("two bands are named \"a\""));
  EXPECT_THAT(error({"a"}), HasSubstr("\"names\" has 1 names for 2 bands"));
  EXPECT_THAT(error({"a", ""}), HasSubstr("a band's name is empty"));
  EXPECT_THAT(error({"a", "b,c"}), HasSubstr("\"b,c\" is no name for a band"));
  EXPECT_THAT(error({"a", "a_se"}), HasSubstr("standard errors"));
  EXPECT_EQ(error({"a", "b"}), "");
  EXPECT_THAT(error_of([] {
                make_bands({number("float", "wavelengths", {500}),
                            {"string", "names", {}, {}, std::vector<std::string>{"green"}}});
              }),
              HasSubstr("\"names\" are those of \"responses\""));
}

/// Against midpoints of 0.001 nm; both factors have points between whole nanometres, and rise where the other does.
TEST_F(Responses, TimesALightAreTheirProduct) {
  const std::vector<ResponsePoint> response{{440.3, 0}, {441, 1}, {447.5, 0.2}, {460, 0}};
  const std::vector<SpectrumPoint> lines{{430, 0.1}, {440.8, 0}, {441.2, 5}, {441.6, 0.5}, {455.5, 2}, {470, 0}};
  const TabulatedSpectrum light(lines);
  const auto lit = lit_response(response, light);
  const ResponseSampler sampler(lit, {});
  double sum = 0, area = 0, moment = 0;
  const auto at = [&](double nm) {
    for (size_t i = 1; i < response.size(); ++i)
      if (nm <= response[i].nm)
        return std::lerp(response[i - 1].value, response[i].value,
                         (nm - response[i - 1].nm) / (response[i].nm - response[i - 1].nm));
    return 0.;
  };
  for (double nm = 440.3005; nm < 460; nm += 0.001) {
    const double r = at(nm), product = r * double(light.at(float(nm)));
    sum += product, area += r, moment += product * nm;
  }
  EXPECT_NEAR(mean_under(response, light), sum / area, 2e-5 * sum / area);
  EXPECT_NEAR(sampler.centroid_nm(), moment / sum, 1e-3);
  const std::vector<SpectrumPoint> elsewhere{{300, 1}, {400, 0}, {600, 0}};
  EXPECT_TRUE(lit_response(response, TabulatedSpectrum(elsewhere)).empty());
  EXPECT_EQ(mean_under(response, TabulatedSpectrum(elsewhere)), 0);
}

TEST(BandPreview, BandsOfOneMeanShareItsWeight) {
  const std::vector<ResponsePoint> response{{549, 1}, {551, 1}};
  const std::vector<Band> bands{{650}, {450}, {550, response, "a"}, {600}, {550, response, "b"}};
  const std::vector<Band> once{{450}, {550}, {600}, {650}};
  const auto shared = xyz_of_bands(bands), alone = xyz_of_bands(once);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(shared[2][c], shared[4][c]);
    EXPECT_DOUBLE_EQ(shared[2][c] + shared[4][c], alone[1][c]);
    EXPECT_EQ(shared[0][c], alone[3][c]);
  }
}

TEST(BandPreview, IsTheColorOfTheSpectrumBetweenTheBands) {
  const auto bands = make_bands(
      {number("float", "lambdamin", {360}), number("float", "lambdamax", {830}), number("float", "step", {5})});
  const std::vector<Triple> weights = xyz_of_bands(bands->bands());
  ASSERT_EQ(weights.size(), 95u);
  Triple xyz{};
  for (size_t b = 0; b < weights.size(); ++b)
    for (size_t c = 0; c < 3; ++c)
      xyz[c] += weights[b][c] * double(unit_d65()->at(static_cast<float>(bands->bands()[b].nm)));
  const Triple exact = to_xyz(*unit_d65());  // D65 is linear between steps of 5 nm
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(xyz[c], exact[c], 1e-5);
}

/// A band of fluorescence adds no reflected light.
TEST(BandPreview, LeavesFluorescenceOut) {
  const auto both = make_bands({number("float", "lambdamin", {400}), number("float", "fluorescence", {685, 740})});
  ASSERT_EQ(both->bands().size(), 33u);
  const std::vector<Triple> weights = xyz_of_bands(both->bands());
  ASSERT_EQ(weights.size(), 33u);
  for (size_t c = 0; c < 3; ++c) EXPECT_EQ(weights[31][c] + weights[32][c], 0);
  EXPECT_GT(weights[15][1], 0);
}

TEST(BandPreview, NeedsTheVisible) {
  EXPECT_THAT(xyz_of_bands(at({450, 550, 650})->bands()), IsEmpty());
  EXPECT_THAT(xyz_of_bands(at({550, 600, 650, 850})->bands()), IsEmpty());
  EXPECT_EQ(xyz_of_bands(at({450, 550, 650, 850})->bands()).size(), 4u);
}

}  // namespace
}  // namespace frond
