#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/math/random.h"
#include "study/compare/cutoff.h"

namespace frond::compare {
namespace {

/// 100 paths, of which 60 continue after one event, 30 after two and none after three.
PathEnds some_ends() {
  PathEnds ends;
  ends.escaped[0] = 25, ends.absorbed[0] = 15, ends.escaped[1] = 30, ends.absorbed[2] = 30;
  return ends;
}

TEST(UnshotRatio, IsWhatWaitsOverWhatWasShot) {
  EXPECT_DOUBLE_EQ(unshot_ratio(some_ends(), 1).value, 60.5 / 100);
  EXPECT_DOUBLE_EQ(unshot_ratio(some_ends(), 2).value, 30.5 / 160);
  EXPECT_DOUBLE_EQ(unshot_ratio(some_ends(), 3).value, 0.5 / 190);
  EXPECT_DOUBLE_EQ(unshot_ratio(some_ends(), 2).relative_error, 1 / std::sqrt(30.5));
  EXPECT_DOUBLE_EQ(unshot_ratio(some_ends(), 1.5).value, std::sqrt(60.5 / 100 * 30.5 / 160));
}

/// Few of many paths go on, a tenth each time; over many such counts the spread of the logarithm equals its stated
/// error.
TEST(UnshotRatio, KnowsItsError) {
  constexpr int kRuns = 1000;
  RandomStream random(7);
  double sum = 0, squares = 0, said = 0;
  for (int run = 0; run < kRuns; ++run) {
    PathEnds ends;
    for (int path = 0; path < 20000; ++path) {
      size_t events = 0;
      while (events < 10 && random.uniform() < 0.1f) ++events;
      ++ends.absorbed[events];
    }
    const UnshotRatio ratio = unshot_ratio(ends, 2.3);
    sum += std::log(ratio.value), squares += std::log(ratio.value) * std::log(ratio.value);
    said += ratio.relative_error * ratio.relative_error / kRuns;
  }
  const double variance = squares / kRuns - sum * sum / kRuns / kRuns;
  // The variance of so many is known to 4.5 %: five such deviations are a false alarm in two million.
  EXPECT_NEAR(variance / said, 1, 5 * 0.045);
}

TEST(DepthOfTrees, IsWhereOneInTenThousandIsLeft) {
  EXPECT_DOUBLE_EQ(depth_of_trees(some_ends()), 3);  // none is left, and half a one of 190 is more
  PathEnds ends;
  ends.absorbed[0] = 1'000'000, ends.absorbed[4] = 300, ends.absorbed[5] = 40;
  const double depth = depth_of_trees(ends);
  EXPECT_GT(depth, 4);
  EXPECT_LT(depth, 5);
  EXPECT_NEAR(unshot_ratio(ends, depth).value, 1e-4, 1e-10);
  ends = {};
  ends.absorbed.back() = 1;
  EXPECT_DOUBLE_EQ(depth_of_trees(ends), PathEnds::kDepths - 1);
  ends = {};
  ends.absorbed[0] = 1;
  EXPECT_DOUBLE_EQ(depth_of_trees(ends), 1);
}

/// A power law of the cutoff, known to so much.
class PowerLaw {
 public:
  PowerLaw(double exponent, double relative_error) : exponent_(exponent), relative_error_(relative_error) {}

  UnshotRatio operator()(double cutoff) {
    tried.push_back(cutoff);
    return {1e-4 * std::pow(cutoff / 0.01, -exponent_), relative_error_};
  }
  std::vector<double> tried;

 private:
  double exponent_, relative_error_;
};

TEST(FitCutoff, StaysWithThePapersWhereThatIsRight) {
  PowerLaw law(1, 0.1);
  const CutoffFit fit = fit_cutoff({1.05e-4, 0.1}, std::ref(law));
  EXPECT_DOUBLE_EQ(fit.cutoff, kPaperCutoff);
  EXPECT_TRUE(fit.equal);
  EXPECT_EQ(law.tried.size(), 1u);
}

TEST(FitCutoff, FindsThatOfAPowerLaw) {
  for (const double exponent : {0.3, 1.0, 2.0})
    for (const double target : {4e-5, 2.5e-4}) {
      PowerLaw law(exponent, 0.01);
      const CutoffFit fit = fit_cutoff({target, 0.01}, std::ref(law));
      const double expected = 0.01 * std::pow(target / 1e-4, -1 / exponent);
      // The search ends within a standard error of the two.
      EXPECT_NEAR(std::log(fit.cutoff / expected), 0, 1.0001 * std::hypot(0.01, 0.01) / exponent)
          << exponent << ' ' << target;
      EXPECT_TRUE(fit.equal);
      EXPECT_LE(law.tried.size(), 13u);
    }
}

/// A wall that reflects 0.015 stands behind the leaves: a larger cutoff takes all paths that met it, of what was shot
/// as well, and the ratio is the same again farther on.
auto with_wall(double relative_error) {
  return [relative_error](double cutoff) {
    return UnshotRatio{1.5e-6 / cutoff * (cutoff > 0.015 ? 3 : 1), relative_error};
  };
}

TEST(FitCutoff, DoesNotStepOverAnAnswerThatIsNear) {
  const CutoffFit fit = fit_cutoff({1.08e-4, 0.05}, with_wall(0.05));
  EXPECT_TRUE(fit.equal);
  EXPECT_LT(fit.cutoff, 0.015);
}

/// One farther on is found where there is none before.
TEST(FitCutoff, LooksForAnAnswerThatAStepWouldPass) {
  const CutoffFit before = fit_cutoff({1.003e-4, 0.005}, with_wall(0.005));
  EXPECT_TRUE(before.equal);
  EXPECT_LT(before.cutoff, 0.015);
  const CutoffFit beyond = fit_cutoff({0.9e-4, 0.005}, with_wall(0.005));
  EXPECT_TRUE(beyond.equal);
  EXPECT_NEAR(beyond.cutoff, 0.05, 0.05 * 1.0001 * std::hypot(0.005, 0.005));
}

TEST(FitCutoff, SaysWhereNoneIsRight) {
  const auto indifferent = [](double) { return UnshotRatio{5e-4, 0.05}; };
  const CutoffFit many = fit_cutoff({1e-4, 0.05}, indifferent);
  EXPECT_FALSE(many.equal);
  EXPECT_DOUBLE_EQ(many.left.value, 5e-4);
  const auto steep = [](double cutoff) { return UnshotRatio{cutoff < 0.02 ? 1e-3 : 1e-6, 0.05}; };
  EXPECT_FALSE(fit_cutoff({1e-4, 0.05}, steep).equal);
}

}  // namespace
}  // namespace frond::compare
