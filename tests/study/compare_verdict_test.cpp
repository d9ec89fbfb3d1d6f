#include <gmock/gmock.h>

#include "study/compare/error_unit.h"
#include "study/compare/report/charts.h"
#include "study/compare/report/verdict.h"
#include "study/compare/speed_up.h"
#include "tests/support/xml.h"

namespace frond::compare {
namespace {

using ::testing::HasSubstr;

/// In every channel: noise of variance `variance` / samples, `seconds` for a sample.
CandidateResult candidate(const std::string& label, double seconds, double variance, double bias) {
  CandidateResult s{.candidate = parse_candidate(label), .wavelengths = "smpte"};
  for (uint64_t n = 1; n <= 16; n *= 2) {
    CandidateRun run{.samples = n, .cost = {seconds * double(n), seconds * double(n), 0}};
    const double noise = variance / double(n);
    for (auto& region : run.errors) region.assign(5, {{noise + bias * bias, 0}, {}, {noise, 0}, {bias * bias, 0}, {}});
    s.runs.push_back(run);
  }
  return s;
}

/// The one is exact and noisy, the other four times as good for its time, with a bias of 0.01.
Comparison two() {
  Comparison c;
  c.width = c.height = 2;
  c.candidates = {candidate("slow", 2, 0.04, 0), candidate("fast", 1, 0.02, 0.01)};
  return c;
}

TEST(Verdict, NamesTheCheapestThatIsGoodEnough) {
  Comparison c = two();
  c.request.rms = {0.05};  // 0.0025 = 0.0001 + 0.02 / n
  EXPECT_THAT(verdict(c), HasSubstr("fast is enough for an RMS of 0.05, with 95 % confidence: 9 samples per pixel"));
  EXPECT_THAT(verdict(c), HasSubstr("; slow takes 32 s"));
}

TEST(Verdict, DoesNotNameTheCheapOneThatIsBiased) {
  Comparison c = two();
  c.request.rms = {0.009};
  EXPECT_THAT(verdict(c), HasSubstr("slow is enough for an RMS of 0.009"));
  EXPECT_THAT(verdict(c), HasSubstr("by extrapolation; fast never gets there"));
}

TEST(Verdict, AnswersEachQuestion) {
  Comparison c = two();
  c.request.rms = {0.05, 0.009};
  EXPECT_THAT(verdict(c), HasSubstr("takes 32 s.\nslow is enough for an RMS of 0.009"));
}

TEST(Verdict, SaysWhenNothingMeetsIt) {
  Comparison c = two();
  c.candidates.erase(c.candidates.begin());
  c.request.rms = {0.009};
  EXPECT_THAT(verdict(c), HasSubstr("None of the candidates meets an RMS of 0.009"));
}

TEST(Verdict, UncertainBiasIsHeldAgainstACandidate) {
  Comparison c = two();
  c.candidates.erase(c.candidates.begin());
  for (auto& region : c.candidates[0].runs.back().errors)
    for (RenderError& e : region) e.bias.standard_error = 0.0001;
  c.request.rms = {0.014};
  // Two bounds at 95 % together: 1 - sqrt(0.95) above each, 1.95 standard errors.
  EXPECT_NEAR(simultaneous_z(c), 1.955, 0.001);
  EXPECT_FALSE(candidate_costs(c, 0.014, simultaneous_z(c))[0].effort);
  EXPECT_FALSE(candidate_costs(c, 0.014, simultaneous_z(c))[0].never);
  EXPECT_TRUE(candidate_costs(c, 0.0001, 0)[0].never);
  EXPECT_TRUE(candidate_costs(c, 0.014, 0)[0].effort);
}

TEST(Verdict, AFewPerCentChangeNoReign) {
  Comparison c;
  c.candidates = {candidate("a", 1, 0.02, 0), candidate("b", 0.99, 0.0201, 0)};
  for (CandidateRun& run : c.candidates[1].runs)
    if (run.samples == 4) run.cost.cpu_seconds *= 1.02;
  EXPECT_EQ(cheapest_ranges(c).size(), 1u);
}

TEST(Verdict, ReignsChangeWhereBiasIsReached) {
  const Comparison c = two();
  const auto all = cheapest_ranges(c);
  ASSERT_EQ(all.size(), 1u);  // the smallest RMS measured is 0.0366, where the fast one is ahead
  EXPECT_EQ(all[0].candidate, 1u);
  EXPECT_THAT(verdict(c), HasSubstr("fast is the cheapest down to an RMS of 0.037"));
}

TEST(SpeedUp, InFourWays) {
  Comparison c = two();
  c.request.target = {0.05, 0.05, 0.05};
  const SpeedUps s = speed_ups(c, 1);
  EXPECT_DOUBLE_EQ(s.equal_samples, 2);
  EXPECT_DOUBLE_EQ(s.equal_noise, 4);
  EXPECT_FALSE(s.paper);
  ASSERT_TRUE(s.equal_error);
  EXPECT_EQ(s.equal_error->kind, Ratio::Kind::measured);
  EXPECT_NEAR(s.equal_error->value, 2 * 16 / (0.02 / 0.0024), 1e-9);
  ASSERT_TRUE(s.equal_error_at_bias);  // 0.015^2 = 0.0001 + 0.02 / 160
  EXPECT_EQ(s.equal_error_at_bias->kind, Ratio::Kind::extrapolated);
  EXPECT_NEAR(s.equal_error_at_bias->value, 2 * (0.04 / 0.000225) / 160, 1e-9);
}

TEST(SpeedUp, SaysWhereAnErrorIsNotReached) {
  Comparison c = two();
  c.request.target = {0.05, 0.009, 0.05};
  EXPECT_EQ(speed_ups(c, 1).equal_error->kind, Ratio::Kind::not_reached);
  c.request.target = {0.05, 0.05, 0.05};
  std::swap(c.candidates[0], c.candidates[1]);
  EXPECT_FALSE(speed_ups(c, 1).equal_error_at_bias);  // it has no bias
  c.request.target = {0.009, 0.05, 0.05};
  EXPECT_EQ(speed_ups(c, 1).equal_error->kind, Ratio::Kind::baseline_not_there);
}

TEST(Figures, AreWrittenWithoutExponents) {
  EXPECT_EQ(figures(1234.5, 3), "1230");
  EXPECT_EQ(figures(199.6, 2), "200");
  EXPECT_EQ(figures(0.017856, 3), "0.0179");
  EXPECT_EQ(figures(0, 3), "0");
}

TEST(CurvesChart, MarksTheBiasOfTheBiased) {
  const std::string svg = chart_svg(curves_chart(two(), Measure::rms_all).value());
  EXPECT_EQ(test::xml_error(svg), "");
  EXPECT_THAT(svg, ::testing::AllOf(HasSubstr(">fast<"), HasSubstr(">bias 0.01, from 200 s on<")));
  EXPECT_THAT(svg, HasSubstr(">slow<"));
}

}  // namespace
}  // namespace frond::compare
