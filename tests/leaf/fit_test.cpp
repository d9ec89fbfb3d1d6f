#include "leaf/fit/fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "leaf/fit/measured_spectra.h"
#include "leaf/solve/solver.h"
#include "leaf/tissue/area_content.h"
#include "tests/support/input_error.h"

namespace frond::leaf {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::vector<LeafMeasurement> spectra_of(const TissueParams& params, const std::vector<double>& theta_deg,
                                        double step_nm) {
  const TissueModel model(params);
  std::vector<LeafMeasurement> measurements;
  for (double nm = 400; nm <= 2500; nm += step_nm) {
    const std::vector<Shares> shares = solve(model.at(nm), theta_deg);
    for (size_t a = 0; a < theta_deg.size(); ++a)
      measurements.push_back({nm, theta_deg[a], shares[a].surface + shares[a].subsurface, shares[a].transmitted});
  }
  return measurements;
}

TissueParams another(std::string_view specimen) {
  TissueParams p = find_specimen(specimen)->params;
  p.thickness_m *= 1.6;
  p.number("chlorophylla") *= 0.5, p.number("chlorophyllb") *= 0.5;
  p.number("carotenoids") *= 1.4;
  p.number("protein") *= 1.5;
  p.number("cellulose") *= 0.7, p.number("lignin") *= 0.7;
  p.number("otherabsorption") = 90;
  p.epidermis_aspect = 3, p.spongy_aspect = 7, p.palisade_aspect = 2;
  p.sieve_and_detour = true;
  return p;
}

/// The same with PROSPECT-D's absorption, a surface that hardly reflects and absorption below the air space.
TissueParams another_of_prospect() {
  TissueParams p = another("soybean");
  p.absorption_tables = AbsorptionTables::prospect;
  p.number("protein") = p.number("cellulose") = p.number("lignin") = 0;
  p.number("anthocyanins") = 0.5, p.number("drymatter") = 200;
  p.spongy_share = 0.25;
  p.cuticle_refractivity = 0.6;
  return p;
}

void expect_found(const TissueParams& truth, const FitRequest& request, double tolerance) {
  const FitResult result = fit_leaf(request, ThreadPool(2));
  EXPECT_LT(result.rmse, 1e-4);
  EXPECT_EQ(result.params.structure, truth.structure);
  EXPECT_EQ(result.params.sieve_and_detour, truth.sieve_and_detour);
  int identified = 0;
  for (const FittedNumber& n : result.numbers) {
    if (!n.is_identified()) continue;
    ++identified;
    // Parameters that the data hardly separate are found within their errors.
    EXPECT_LT(std::abs(std::log(n.value / n.variable->value(truth))), std::max(tolerance, n.relative_error))
        << n.variable->name;
  }
  EXPECT_GE(identified, 4);
}

TEST(Fit, FindsALeafAgainByItsSpectra) {
  for (const std::string_view specimen : {"soybean", "maize"}) {
    const TissueParams truth = another(specimen);
    expect_found(truth, {.measurements = spectra_of(truth, {8}, 10), .absorption_tables = AbsorptionTables::baranoski},
                 0.03);
  }
}

TEST(Fit, FindsALeafOfProspectsAbsorptionAgain) {
  const TissueParams truth = another_of_prospect();
  const FitRequest request{.measurements = spectra_of(truth, {8}, 10)};
  expect_found(truth, request, 0.03);
  EXPECT_TRUE(fit_leaf(request, ThreadPool(2)).misfits.empty());
}

/// R without the specular part lies below the surface's share of the published cuticle, 0.04.
TEST(Fit, FollowsLeavesThatAreDarkerThanTheCuticle) {
  TissueParams truth = another_of_prospect();
  truth.number("chlorophylla") *= 4, truth.number("chlorophyllb") *= 4, truth.cuticle_refractivity = 0.4;
  const FitRequest request{.measurements = spectra_of(truth, {8}, 10)};
  const auto red = std::ranges::find(request.measurements, 670.0, &LeafMeasurement::lambda_nm);
  EXPECT_LT(*red->r, 0.025);
  const FitResult result = fit_leaf(request, ThreadPool(2));
  EXPECT_NEAR(result.fitted[static_cast<size_t>(red - request.measurements.begin())].r, *red->r, 1e-3);
}

TEST(Fit, NamesTheBandsThatItMisses) {
  const TissueParams truth = another_of_prospect();
  FitRequest request{.measurements = spectra_of(truth, {8}, 10)};
  for (LeafMeasurement& m : request.measurements)
    if (m.lambda_nm >= 600 && m.lambda_nm <= 680) m.r = 0.001;  // darker than any surface
  request.measurements[100].t = 0.9;                            // one bad point is no band
  const FitResult result = fit_leaf(request, ThreadPool(2));
  const auto dark = std::ranges::find_if(
      result.misfits, [](const MisfitBand& b) { return !b.is_t && b.nm.min >= 590 && b.nm.max <= 690; });
  ASSERT_NE(dark, result.misfits.end());
  EXPECT_GE(dark->nm.max - dark->nm.min, 50);
  EXPECT_GT(dark->lowest_r, 0.001);
  EXPECT_LE(dark->lowest_r, dark->fitted);
  for (const MisfitBand& b : result.misfits) EXPECT_TRUE(b.nm.max > b.nm.min) << b.nm.min;
}

TEST(Fit, KeepsContentsPerAreaWhileTheThicknessIsFitted) {
  const TissueParams truth = another_of_prospect();
  FitRequest request{.measurements = spectra_of(truth, {8}, 50), .structure = truth.structure, .sieve = true};
  request.fixed = {{"chlorophyll", 40 / kMicrogramsPerCm2.per_kg_per_m2, true},
                   {"drymatter", 0.004 / kGramsPerCm2.per_kg_per_m2, true}};
  const FitResult result = fit_leaf(request, ThreadPool(2));
  const TissueParams& p = result.params;
  EXPECT_NEAR(area_content(p, p.number("chlorophylla") + p.number("chlorophyllb")), 4e-4, 1e-12);
  EXPECT_NEAR(area_content(p, p.number("drymatter")), 0.04, 1e-12);
  const auto chlorophyll = std::ranges::find(result.contents, "chlorophyll", &FittedContent::name);
  ASSERT_NE(chlorophyll, result.contents.end());
  EXPECT_NEAR(chlorophyll->relative_error, 0, 1e-9);
  request.fixed = {{"water", 0.012 / kGramsPerCm2.per_kg_per_m2, true}};
  EXPECT_NEAR(fit_leaf(request, ThreadPool(2)).params.thickness_m, 0.12 / 1000 / 0.5, 1e-12);
}

TEST(Fit, TakesBothSidesAndSeveralAngles) {
  const TissueParams truth = another("soybean");
  expect_found(truth,
               {.measurements = spectra_of(truth, {8, 50, 172}, 25),
                .structure = truth.structure,
                .absorption_tables = AbsorptionTables::baranoski},
               0.03);
}

/// R of a leaf on a white pad, from the R and T of both sides: the lower side is lit by diffuse light, whose R and T
/// are means over the cosines of 8 angles.
TEST(Fit, TakesABackground) {
  const TissueParams truth = find_specimen("tomato")->params;
  const TissueModel model(truth);
  constexpr double kBackground = 0.9;
  const std::vector<double> nodes{0.0625, 0.1875, 0.3125, 0.4375, 0.5625, 0.6875, 0.8125, 0.9375};
  std::vector<double> theta_deg{8};
  for (const double x : nodes) theta_deg.push_back(180 - std::acos(std::sqrt(x)) * 180 / std::numbers::pi);
  FitRequest on_pad;
  on_pad.background = kBackground;
  for (double nm = 400; nm <= 2500; nm += 30) {
    const std::vector<Shares> shares = solve(model.at(nm), theta_deg);
    double r = 0, t = 0;
    for (size_t i = 1; i < shares.size(); ++i)
      r += (shares[i].surface + shares[i].subsurface) / 8, t += shares[i].transmitted / 8;
    const double front = shares[0].surface + shares[0].subsurface;
    on_pad.measurements.push_back({nm, 8, front + shares[0].transmitted * t * kBackground / (1 - r * kBackground), {}});
  }
  FitRequest ignored = on_pad;
  ignored.background = 0;
  const FitResult of_pad = fit_leaf(on_pad, ThreadPool(2));
  const auto off = [&truth](const TissueParams& p, std::string_view name) {
    return p.number(name) * p.thickness_m / (truth.number(name) * truth.thickness_m) - 1;
  };
  EXPECT_LT(std::abs(off(of_pad.params, "chlorophylla")), 0.1);
  EXPECT_LT(std::abs(of_pad.params.thickness_m / truth.thickness_m - 1), 0.1);
  EXPECT_LT(of_pad.rmse, 0.01);
  // Without the background no leaf of the walk is as bright in the near infrared.
  EXPECT_GT(fit_leaf(ignored, ThreadPool(2)).rmse, 0.02);
}

TEST(Fit, KeepsWhatIsFixed) {
  const TissueParams truth = another("soybean");
  FitRequest request{.measurements = spectra_of(truth, {8}, 50),
                     .structure = truth.structure,
                     .sieve = true,
                     .absorption_tables = AbsorptionTables::baranoski};
  request.fixed = {{"chlorophylla", truth.number("chlorophylla")},
                   {"chlorophyllb", truth.number("chlorophyllb")},
                   {"palisadeaspect", 2}};
  const FitResult result = fit_leaf(request, ThreadPool(2));
  EXPECT_EQ(result.params.number("chlorophylla"), truth.number("chlorophylla"));
  EXPECT_EQ(result.params.number("chlorophyllb"), truth.number("chlorophyllb"));
  EXPECT_EQ(result.params.palisade_aspect, 2);
  EXPECT_EQ(std::ranges::count(result.numbers, true, &FittedNumber::is_fixed), 2);
  EXPECT_LT(result.rmse, 1e-3);
}

/// One reading in twenty is anything at all.
TEST(Fit, IsNotLedAstrayByBadPoints) {
  const TissueParams truth = another("soybean");
  FitRequest request{.measurements = spectra_of(truth, {8}, 10),
                     .structure = truth.structure,
                     .sieve = true,
                     .absorption_tables = AbsorptionTables::baranoski};
  RandomStream rng(4);
  for (size_t i = 0; i < request.measurements.size(); i += 20) request.measurements[i].r = rng.uniform_double();
  const FitResult result = fit_leaf(request, ThreadPool(2));
  double largest = 0;
  for (size_t i = 0; i < request.measurements.size(); ++i)
    if (i % 20 != 0) largest = std::max(largest, std::abs(result.fitted[i].r - *request.measurements[i].r));
  EXPECT_LT(largest, 0.02);
  EXPECT_GE(std::ranges::count(result.fitted, true, &FitResult::Fitted::is_outlier), 5);
}

constexpr double kNoise = 0.003;

/// Normal numbers with the standard deviation 1.
struct Normal {
  RandomStream rng;
  double operator()() {
    return std::sqrt(-2 * std::log(1 - rng.uniform_double())) * std::cos(2 * std::numbers::pi * rng.uniform_double());
  }
};

/// A leaf for which the anthocyanins once went to the end of their range in the first steps of the search and stayed
/// there: the fit ended as a leaf of another kind, with 3.5 times the noise.
TEST(Fit, NoPigmentStaysAtTheEndOfItsRange) {
  TissueParams truth = find_specimen("soybean")->params;
  truth.absorption_tables = AbsorptionTables::prospect;
  truth.sieve_and_detour = false, truth.thickness_m = 352.9e-6;
  truth.number("chlorophylla") = 2.726, truth.number("chlorophyllb") = 0.909, truth.number("carotenoids") = 0.4091,
  truth.number("anthocyanins") = 0.0673;
  truth.number("protein") = truth.number("cellulose") = truth.number("lignin") = 0;
  truth.number("drymatter") = 355.8, truth.number("otherabsorption") = 191.4;
  truth.epidermis_aspect = 3, truth.spongy_aspect = 1, truth.palisade_aspect = 10;
  truth.spongy_share = 0.0386, truth.cuticle_refractivity = 1.117;
  FitRequest request{.measurements = spectra_of(truth, {8}, 10)};
  Normal normal{RandomStream(7)};
  for (LeafMeasurement& m : request.measurements) *m.r += kNoise * normal(), *m.t += kNoise * normal();
  const FitResult result = fit_leaf(request, ThreadPool(2));
  EXPECT_LT(result.rmse, 1.2 * kNoise);  // 6 standard deviations of the noise's RMS
  EXPECT_FALSE(result.params.sieve_and_detour);
}

/// Noise moves the contents by as much as their errors say. With a fixed seed the test always ends the same way; with
/// another one a correct fit fails with a probability of 1e-3: 18 numbers beyond 4 standard errors, each 6e-5.
TEST(Fit, ErrorsAreThoseOfTheNoise) {
  const TissueParams truth = another_of_prospect();
  const std::vector<LeafMeasurement> exact = spectra_of(truth, {8}, 20);
  Normal normal{RandomStream(5)};
  FitCache cache;
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 6; ++i) {
    FitRequest request{.measurements = exact, .structure = truth.structure, .sieve = true};
    for (LeafMeasurement& m : request.measurements) *m.r += kNoise * normal(), *m.t += kNoise * normal();
    const FitResult result = fit_leaf(request, ThreadPool(1), &cache);
    EXPECT_NEAR(result.rmse, kNoise, 0.2 * kNoise);
    for (const FittedContent& c : result.contents) {
      double expected = 0;
      if (c.name == "chlorophyll")
        expected = area_content(truth, truth.number("chlorophylla") + truth.number("chlorophyllb"));
      if (c.name == "water") expected = area_content(truth, kWaterConcentration);
      if (c.name == "drymatter") expected = area_content(truth, truth.number("drymatter"));
      if (expected == 0) continue;
      const double z = std::log(c.kg_per_m2 / expected) / c.relative_error;
      EXPECT_LT(std::abs(z), 4) << c.name;
      sum += z * z, ++count;
    }
  }
  EXPECT_EQ(count, 18);
  EXPECT_GT(sum / count, 0.2);  // the errors are not much too large
}

/// Visible light alone does not determine constituents that absorb beyond it.
TEST(Fit, SaysWhatTheDataDoNotTell) {
  const TissueParams truth = find_specimen("soybean")->params;
  FitRequest request{.measurements = spectra_of(truth, {8}, 10),
                     .structure = truth.structure,
                     .sieve = false,
                     .absorption_tables = AbsorptionTables::baranoski};
  std::erase_if(request.measurements, [](const LeafMeasurement& r) { return r.lambda_nm > 700; });
  const FitResult result = fit_leaf(request, ThreadPool(2));
  for (const FittedNumber& n : result.numbers) {
    if (n.variable->name == "protein" || n.variable->name == "cellulose") {
      EXPECT_FALSE(n.is_identified()) << n.variable->name;
    }
  }
}

TEST(Fit, IsTheSameOnAnyNumberOfThreads) {
  const FitRequest request{.measurements = spectra_of(find_specimen("maize")->params, {8}, 100)};
  EXPECT_EQ(fit_leaf(request, ThreadPool(1)).params, fit_leaf(request, ThreadPool(3)).params);
}

/// The search interpolates; the reported values do not. 4 nodes per segment, as the fit has, are within 5e-4 of more.
TEST(Fit, ReportsTheSolvedWalk) {
  const FitRequest request{.measurements = spectra_of(another_of_prospect(), {8}, 50)};
  const FitResult result = fit_leaf(request, ThreadPool(1));
  const TissueModel model(result.params);
  for (size_t i = 0; i < request.measurements.size(); ++i) {
    const Tissue tissue = model.at(request.measurements[i].lambda_nm);
    const Shares same = solve(tissue, std::array{8.0}, 4)[0], better = solve(tissue, std::array{8.0})[0];
    EXPECT_NEAR(result.fitted[i].r, same.surface + same.subsurface, 2e-6);
    EXPECT_NEAR(result.fitted[i].t, same.transmitted, 2e-6);
    EXPECT_NEAR(result.fitted[i].r, better.surface + better.subsurface, 5e-4);
    EXPECT_NEAR(result.fitted[i].t, better.transmitted, 5e-4);
  }
}

/// With more than 450 rows, some rows are interpolated and not solved.
TEST(Fit, FitsSpectraOfManyWavelengthsAsThoseOfFew) {
  const TissueParams truth = another_of_prospect();
  FitRequest request{.measurements = spectra_of(truth, {8, 172}, 7), .structure = truth.structure, .sieve = true};
  std::ranges::reverse(request.measurements);
  const FitResult result = fit_leaf(request, ThreadPool(2));
  ASSERT_GT(request.measurements.size(), 450u);
  EXPECT_LT(result.rmse, 1e-4);
  const TissueModel model(result.params);
  for (size_t i = 0; i < request.measurements.size(); i += 3) {
    const LeafMeasurement& m = request.measurements[i];
    const Shares same = solve(model.at(m.lambda_nm), std::array{m.theta_deg}, 4)[0];
    EXPECT_NEAR(result.fitted[i].r, same.surface + same.subsurface, 2e-4);
    EXPECT_NEAR(result.fitted[i].t, same.transmitted, 2e-4);
  }
}

TEST(Fit, IsTheSameWithACacheOfOtherFits) {
  FitCache cache;
  const auto of = [](const char* specimen) {
    return FitRequest{.measurements = spectra_of(find_specimen(specimen)->params, {8}, 100)};
  };
  const FitResult alone = fit_leaf(of("maize"), ThreadPool(1));
  fit_leaf(of("soybean"), ThreadPool(1), &cache);
  const FitResult later = fit_leaf(of("maize"), ThreadPool(1), &cache);
  EXPECT_EQ(alone.params, later.params);
  EXPECT_EQ(alone.rmse, later.rmse);
}

TEST(Fit, ThreadsThatShareACacheFindTheSame) {
  FitCache cache;
  std::vector<FitRequest> requests;
  for (const double scale : {1.0, 0.95, 0.9, 0.85}) {
    requests.push_back({.measurements = spectra_of(find_specimen("soybean")->params, {8}, 100)});
    for (LeafMeasurement& m : requests.back().measurements) *m.r *= scale;
  }
  std::vector<FitResult> results(requests.size());
  ThreadPool(3).for_each(static_cast<int64_t>(requests.size()), [&](int64_t i, int) {
    results[static_cast<size_t>(i)] = fit_leaf(requests[static_cast<size_t>(i)], ThreadPool(1), &cache);
  });
  for (size_t i = 0; i < requests.size(); ++i)
    EXPECT_EQ(results[i].params, fit_leaf(requests[i], ThreadPool(1)).params) << i;
}

TEST(MeasuredSpectra, AreReadAsInstrumentsWriteThem) {
  const auto read = [](std::string_view text, const SpectraMeasurement& how = {}) {
    return parse_measured_spectra(text, "a.csv", how);
  };
  const MeasuredSpectra own =
      read("# a comment\ntheta_deg,wavelength_nm,Rs,Rd,R,T,A\n8,550,.04,.06,.1,.2,.7\n172,550,0,0,.2,,1\n");
  ASSERT_EQ(own.measurements.size(), 2u);
  EXPECT_EQ(own.measurements[0].r, 0.1);
  EXPECT_EQ(own.measurements[0].t, 0.2);
  EXPECT_EQ(own.measurements[1].theta_deg, 172);
  EXPECT_FALSE(own.measurements[1].t.has_value());
  const MeasuredSpectra percents =
      read("Wavelength [nm];Reflectance (%);Transmittance (%)\r\n550,5;10,5;20\r\n350;1;1\r\n");
  EXPECT_EQ(percents.in_percent, "R and T");
  EXPECT_EQ(percents.left_out, 1u);
  ASSERT_EQ(percents.measurements.size(), 1u);
  EXPECT_EQ(percents.measurements[0].lambda_nm, 550.5);
  EXPECT_DOUBLE_EQ(*percents.measurements[0].r, 0.105);
  const MeasuredSpectra plain = read("0.55  0.1\n0.56  0.2\n");
  ASSERT_EQ(plain.measurements.size(), 2u);
  EXPECT_DOUBLE_EQ(plain.measurements[1].lambda_nm, 560);
  const std::string two = "leaf,nm,R,side\noak,550,.1,upper\nelm,550,.2,lower\n";
  const MeasuredSpectra elm = read(two, {.leaf = "elm"});
  ASSERT_EQ(elm.measurements.size(), 1u);
  EXPECT_EQ(elm.measurements[0].theta_deg, 172);
}

TEST(MeasuredSpectra, AbsorptanceGivesTheOtherShare) {
  const auto read = [](std::string_view text) { return parse_measured_spectra(text, "a.csv", {}); };
  const MeasuredSpectra with_r = read("nm,R,A\n550,.25,.5\n560,.25,.7505\n570,,.5\n580,.25,\n");
  EXPECT_EQ(with_r.derived, 'T');
  ASSERT_EQ(with_r.measurements.size(), 3u);
  EXPECT_EQ(with_r.measurements[0].t, 0.25);
  EXPECT_NEAR(*with_r.measurements[1].t, -0.0005, 1e-12);
  EXPECT_FALSE(with_r.measurements[2].t);
  EXPECT_EQ(with_r.left_out, 1u);
  const MeasuredSpectra with_t = read("Wavelength;T (%);Absorptance (%)\n550;20;50,5\n");
  EXPECT_EQ(with_t.derived, 'R');
  EXPECT_EQ(with_t.in_percent, "T and A");
  EXPECT_NEAR(*with_t.measurements[0].r, 0.295, 1e-12);
  EXPECT_EQ(read("nm,R,A\n550,4,95\n560,5,94\n").in_percent, "R and A");
  const MeasuredSpectra all = read("nm,R,T,A,Rs,comment\n550,.25,.2,.9,0,x\n");
  EXPECT_EQ(all.derived, 0);
  EXPECT_EQ(all.measurements[0].t, 0.2);
  EXPECT_THAT(all.unused, testing::ElementsAre("A", "Rs", "comment"));
  const auto error = [&](std::string_view text) { return error_of([&] { read(text); }); };
  EXPECT_THAT(error("nm,A\n550,.5\n"), HasSubstr("neither a column of reflectances"));
  EXPECT_THAT(error("nm,R,A\n550,.5,.7\n"), AllOf(HasSubstr("a.csv:2:5"), HasSubstr("R + A is 1.2")));
  EXPECT_THAT(error("nm,R,A\n500,.1,.5\n510,.1,1.3\n520,.1,.5\n"), AllOf(HasSubstr("a.csv:3:8"), HasSubstr("A is a")));
  EXPECT_THAT(error("nm,R,A\n500,30,.5\n510,30,.4\n"), HasSubstr("R looks like percent and A like fractions"));
}

TEST(MeasuredSpectra, ThatAreWrongAreRefusedWithThePlace) {
  const auto error = [](std::string_view text, const SpectraMeasurement& how = {}) {
    return error_of([&] { parse_measured_spectra(text, "a.csv", how); });
  };
  EXPECT_THAT(error(""), HasSubstr("no spectra"));
  EXPECT_THAT(error("nm,x\n1,2\n"), AllOf(HasSubstr("a.csv:1:1"), HasSubstr("\"R\"")));
  EXPECT_THAT(error("R,T\n.1,.2\n"), HasSubstr("no column of wavelengths"));
  EXPECT_THAT(error("nm,R\n550,.1\n560,abc\n"), AllOf(HasSubstr("a.csv:3:5"), HasSubstr("\"abc\"")));
  EXPECT_THAT(error("nm,R\n550\n"), AllOf(HasSubstr("a.csv:2:1"), HasSubstr("2 columns")));
  EXPECT_THAT(error("nm,R\n-3,.1\n"), HasSubstr("above 0"));
  EXPECT_THAT(error("nm,R,T\n550,.7,.6\n"), AllOf(HasSubstr("a.csv:2"), HasSubstr("R + T is 1.3")));
  EXPECT_THAT(error("leaf,nm,R\noak,550,.1\nelm,550,.2\n"), AllOf(HasSubstr("2 leaves"), HasSubstr("elm, oak")));
  EXPECT_THAT(error("leaf,nm,R\noak,550,.1\n", {.leaf = "oaks"}), HasSubstr("did you mean \"oak\"?"));
  EXPECT_THAT(error("nm,R\n550,.1\n", {.leaf = "oak"}), HasSubstr("has no names of leaves"));
  EXPECT_THAT(error("nm,R,side\n550,.1,middle\n"), HasSubstr("adaxial"));
  EXPECT_THAT(error("550 .1 .2 .3\n"), HasSubstr("4 columns"));
  // Values that no spectrometer measures.
  EXPECT_THAT(error("nm,R\n500,.3\n510,-5\n520,.3\n"), AllOf(HasSubstr("a.csv:3:5"), HasSubstr("\"-5\"")));
  EXPECT_THAT(error("nm,R,T\n500,.3,.1\n510,.3,5\n520,.3,.1\n"), AllOf(HasSubstr("a.csv:3:8"), HasSubstr("\"5\"")));
  EXPECT_THAT(error("nm,R\n500,30\n510,120\n520,30\n"), AllOf(HasSubstr("a.csv:3:5"), HasSubstr("\"120\"")));
  EXPECT_THAT(error("nm,R\n500,inf\n"), HasSubstr("a.csv:2:5"));
}

TEST(Fit, WhatIsNotMeasuredHasNoError) {
  FitRequest request{.measurements = spectra_of(find_specimen("soybean")->params, {8}, 100)};
  for (LeafMeasurement& m : request.measurements) m.t.reset();
  const FitResult result = fit_leaf(request, ThreadPool(1));
  EXPECT_FALSE(result.rmse_t);
  ASSERT_TRUE(result.rmse_r);
  EXPECT_EQ(*result.rmse_r, result.rmse);
}

TEST(MeasuredLeaves, AreReadInOrderWithTheErrorsOfEach) {
  const std::vector<MeasuredLeaf> leaves = parse_measured_leaves(
      "leaf,nm,R\noak,550,.1\nelm,550,.2\noak,560,.3\nash,nan,.1\nash,550,.1\nelm,100000,.2\nfir,550\n", "a.csv", {});
  ASSERT_EQ(leaves.size(), 4u);
  EXPECT_EQ(leaves[0].name, "oak");
  EXPECT_EQ(leaves[0].spectra.measurements.size(), 2u);
  EXPECT_EQ(leaves[0].error, "");
  EXPECT_EQ(leaves[1].spectra.left_out, 1u);
  EXPECT_THAT(leaves[2].error, AllOf(HasSubstr("a.csv:5:5"), HasSubstr("above 0")));
  EXPECT_THAT(leaves[3].error, AllOf(HasSubstr("a.csv:8:1"), HasSubstr("3 columns")));
  EXPECT_EQ(parse_measured_leaves("nm,R\n550,.1\n", "a.csv", {})[0].name, "");
  EXPECT_THAT(error_of([] { parse_measured_leaves("leaf,nm,x\noak,1,2\n", "a.csv", {}); }), HasSubstr("\"R\""));
  EXPECT_THAT(error_of([] { parse_measured_leaves("leaf,nm,R\n", "a.csv", {}); }), HasSubstr("no spectra"));
}

TEST(MeasuredLeaves, HaveOneUnitForAll) {
  const std::vector<MeasuredLeaf> leaves =
      parse_measured_leaves("leaf,nm,R\ndark,550,.9\nlight,550,40\nlight,560,50\n", "a.csv", {});
  EXPECT_DOUBLE_EQ(*leaves[0].spectra.measurements[0].r, 0.009);
  EXPECT_EQ(leaves[1].spectra.in_percent, "R");
}

TEST(MeasuredSpectra, AreInPercentIfMostValuesOrTheirColumnsSaySo) {
  const auto is_in_percent = [](std::string_view text) {
    return !parse_measured_spectra(text, "a.csv", {}).in_percent.empty();
  };
  EXPECT_TRUE(is_in_percent("nm,R\n500,1.2\n510,30\n520,40\n"));
  EXPECT_TRUE(is_in_percent("nm,R (%)\n500,1.2\n510,.9\n"));
  EXPECT_FALSE(is_in_percent("nm,R\n500,.012\n510,1\n"));
}

TEST(MeasuredSpectra, EachColumnHasItsUnit) {
  const auto in_percent = [](std::string_view text) { return parse_measured_spectra(text, "a.csv", {}).in_percent; };
  EXPECT_EQ(in_percent("nm,R (%),T\n500,25,.2\n510,30,.2\n"), "R");
  EXPECT_EQ(in_percent("nm,R,T\n500,6,1.2\n510,6,1.1\n"), "R and T");
  EXPECT_THAT(error_of([&] { in_percent("nm,R,T\n500,25,.2\n510,30,.2\n"); }),
              HasSubstr("R looks like percent and T like fractions: name the columns with their units"));
}

/// A name as frond spectrophotometer writes a material with parameters.
TEST(MeasuredSpectra, FieldsInQuotesCanHoldTheSeparator) {
  const MeasuredSpectra read =
      parse_measured_spectra("nm,R,material\n550,.1,\"leaf_solved,specimen=maize\"\n", "a.csv", {});
  EXPECT_EQ(read.measurements.size(), 1u);
}

/// R and T of three leaves by PROSPECT-D (Feret et al. 2017), as prosail 2.0.5 computes them. Contents: chlorophyll 40,
/// 20 and 5 ug/cm2, carotenoids 8, 6 and 3, anthocyanins 0, 20 and 2, brown pigments 0, 0 and 0.8, water 0.01, 0.01 and
/// 0.004 g/cm2, dry matter 0.009, 0.009 and 0.012 g/cm2.
struct ProspectRow {
  double lambda_nm, green_r, green_t, red_r, red_t, brown_r, brown_t;
};
constexpr ProspectRow kProspectLeaves[] = {
    {400, 0.043118, 0.000331, 0.043142, 0.000472, 0.049524, 0.002102},
    {420, 0.042077, 0.000591, 0.042307, 0.001592, 0.062750, 0.007906},
    {440, 0.041406, 0.000631, 0.041713, 0.001917, 0.072020, 0.012460},
    {460, 0.041634, 0.003500, 0.041990, 0.004520, 0.087243, 0.020189},
    {480, 0.042268, 0.006192, 0.041873, 0.005176, 0.095345, 0.024618},
    {500, 0.050520, 0.022996, 0.042687, 0.008169, 0.114438, 0.035214},
    {520, 0.110251, 0.101381, 0.045760, 0.015769, 0.146935, 0.054689},
    {540, 0.154255, 0.152226, 0.047226, 0.020124, 0.173744, 0.072666},
    {560, 0.141082, 0.140682, 0.051491, 0.029255, 0.192966, 0.087105},
    {580, 0.096717, 0.092370, 0.062519, 0.047951, 0.207360, 0.099096},
    {600, 0.078995, 0.072191, 0.082986, 0.077344, 0.225084, 0.113582},
    {620, 0.062590, 0.051235, 0.092880, 0.091394, 0.232634, 0.120675},
    {640, 0.053905, 0.039037, 0.093186, 0.092773, 0.236280, 0.124387},
    {660, 0.040585, 0.015928, 0.066948, 0.058640, 0.213215, 0.108149},
    {680, 0.036002, 0.005272, 0.049458, 0.032455, 0.185716, 0.089146},
    {700, 0.127387, 0.135124, 0.210328, 0.227152, 0.332935, 0.199736},
    {720, 0.306582, 0.330005, 0.364602, 0.389868, 0.393330, 0.250006},
    {740, 0.405740, 0.434521, 0.423880, 0.453063, 0.423032, 0.276746},
    {800, 0.442543, 0.474635, 0.442543, 0.474635, 0.470263, 0.318895},
    {900, 0.441550, 0.474204, 0.441550, 0.474204, 0.506919, 0.351062},
    {1000, 0.433982, 0.470121, 0.433982, 0.470121, 0.515785, 0.362017},
    {1100, 0.434498, 0.478460, 0.434498, 0.478460, 0.520033, 0.372695},
    {1200, 0.413188, 0.464797, 0.413188, 0.464797, 0.509207, 0.370717},
    {1300, 0.403342, 0.462742, 0.403342, 0.462742, 0.497289, 0.367580},
    {1400, 0.241646, 0.294920, 0.241646, 0.294920, 0.403255, 0.291306},
    {1500, 0.209295, 0.266873, 0.209295, 0.266873, 0.355251, 0.258237},
    {1600, 0.297307, 0.379965, 0.297307, 0.379965, 0.409561, 0.318599},
    {1700, 0.294325, 0.389333, 0.294325, 0.389333, 0.392254, 0.314599},
    {1800, 0.270037, 0.370101, 0.270037, 0.370101, 0.384692, 0.316213},
    {1900, 0.051677, 0.076179, 0.051677, 0.076179, 0.183011, 0.134699},
    {2000, 0.072066, 0.114719, 0.072066, 0.114719, 0.208932, 0.162269},
    {2100, 0.126360, 0.204010, 0.126360, 0.204010, 0.225455, 0.184307},
    {2200, 0.154747, 0.253136, 0.154747, 0.253136, 0.244657, 0.211366},
    {2300, 0.107624, 0.191474, 0.107624, 0.191474, 0.177670, 0.152888},
    {2400, 0.072390, 0.137475, 0.072390, 0.137475, 0.158028, 0.138288},
    {2500, 0.033560, 0.058345, 0.033560, 0.058345, 0.097886, 0.077320},
};

/// Measurements of one of them; `leaf` is 0, 1 or 2.
std::vector<LeafMeasurement> prospect_leaf(int leaf) {
  std::vector<LeafMeasurement> measurements;
  for (const ProspectRow& row : kProspectLeaves) {
    const double r[] = {row.green_r, row.red_r, row.brown_r}, t[] = {row.green_t, row.red_t, row.brown_t};
    measurements.push_back({row.lambda_nm, 8, r[leaf], t[leaf]});
  }
  return measurements;
}

double content(const FitResult& result, std::string_view name) {
  return std::ranges::find(result.contents, name, &FittedContent::name)->kg_per_m2;
}

TEST(Fit, FindsTheAnthocyaninsAndBrownPigmentsOfAutumn) {
  const ThreadPool pool(2);
  const FitResult green = fit_leaf({.measurements = prospect_leaf(0)}, pool),
                  red = fit_leaf({.measurements = prospect_leaf(1)}, pool),
                  brown = fit_leaf({.measurements = prospect_leaf(2)}, pool);
  EXPECT_LT(green.rmse, 0.01);
  EXPECT_LT(red.rmse, 0.01);
  EXPECT_LT(brown.rmse, 0.02);
  // The models differ, so contents agree only about: within a tenth where a pigment dominates.
  EXPECT_NEAR(content(red, "anthocyanins") * kMicrogramsPerCm2.per_kg_per_m2, 20, 2);
  EXPECT_NEAR(content(red, "chlorophyll") * kMicrogramsPerCm2.per_kg_per_m2, 20, 2);
  EXPECT_NEAR(content(brown, "brownpigments"), 0.8, 0.15);
  EXPECT_LT(content(green, "anthocyanins") * kMicrogramsPerCm2.per_kg_per_m2, 1);
  EXPECT_LT(content(green, "brownpigments"), 0.04);
  // Difference of the absorption from the green leaf's, by band.
  for (const Interval& nm : {Interval{500, 600}, Interval{600, 680}, Interval{680, 760}})
    for (const auto& [leaf, other] : {std::pair(1, &red), std::pair(2, &brown)}) {
      double truth = 0, fitted = 0;
      const auto there = prospect_leaf(leaf), here = prospect_leaf(0);
      for (size_t i = 0; i < here.size(); ++i) {
        if (!nm.contains(here[i].lambda_nm)) continue;
        truth += *there[i].r + *there[i].t - *here[i].r - *here[i].t;
        fitted += other->fitted[i].r + other->fitted[i].t - green.fitted[i].r - green.fitted[i].t;
      }
      EXPECT_NEAR(fitted / truth, 1, 0.2) << leaf << " from " << nm.min << " nm";
    }
}

TEST(Fit, SpecimensOfAutumnAreThoseLeaves) {
  for (const auto& [name, leaf] : {std::pair("red", 1), std::pair("autumn", 2)}) {
    const TissueModel model(find_specimen(name)->params);
    double sum = 0;
    const auto measurements = prospect_leaf(leaf);
    for (const LeafMeasurement& m : measurements) {
      const Shares s = solve(model.at(m.lambda_nm), std::array{m.theta_deg})[0];
      sum += std::pow(s.surface + s.subsurface - *m.r, 2) + std::pow(s.transmitted - *m.t, 2);
    }
    EXPECT_LT(std::sqrt(sum / double(2 * measurements.size())), 0.02) << name;
  }
}

}  // namespace
}  // namespace frond::leaf
