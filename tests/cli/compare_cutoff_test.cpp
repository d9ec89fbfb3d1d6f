#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "cli/compare/cutoff.h"

namespace frond::compare {
namespace {

/// Of 100 paths 60 go on after one event, 30 after two; none after three.
PathEnds some_ends() {
  PathEnds ends;
  ends.escaped[0] = 25, ends.absorbed[0] = 15, ends.escaped[1] = 30, ends.absorbed[2] = 30;
  return ends;
}

TEST(Unshot, IsWhatWaitsOverWhatWasShot) {
  const Unshot after_one = unshot_after(some_ends(), 1), after_two = unshot_after(some_ends(), 2);
  EXPECT_EQ(after_one.unshot, 60u);
  EXPECT_EQ(after_one.shot, 100u);
  EXPECT_EQ(after_two.unshot, 30u);
  EXPECT_EQ(after_two.shot, 160u);
  EXPECT_EQ(unshot_after(some_ends(), 3).unshot, 0u);
}

TEST(Unshot, TreesEndBelowOneInTenThousand) {
  EXPECT_EQ(depth_of_trees(some_ends()), 3u);
  PathEnds ends;
  ends.absorbed[0] = 1'000'000, ends.absorbed[4] = 101, ends.absorbed[5] = 99;
  EXPECT_EQ(depth_of_trees(ends), 5u);
  ends = {};
  ends.absorbed.back() = 1;
  EXPECT_EQ(depth_of_trees(ends), PathEnds::kDepths - 1);
}

/// A power law of the cutoff, counted.
class PowerLaw {
 public:
  explicit PowerLaw(double exponent) : exponent_(exponent) {}

  Unshot operator()(double cutoff) {
    tried.push_back(cutoff);
    return {uint64_t(std::lround(1e9 * 1e-5 * std::pow(cutoff / 0.01, -exponent_))), 1'000'000'000};
  }
  std::vector<double> tried;

 private:
  double exponent_;
};

TEST(FitCutoff, StaysWithThePapersWhereThatIsRight) {
  PowerLaw law(1);
  const CutoffFit fit = fit_cutoff({10'000, 1'000'000'000}, std::ref(law));
  EXPECT_DOUBLE_EQ(fit.cutoff, kPaperCutoff);
  EXPECT_TRUE(fit.equal);
  EXPECT_EQ(law.tried.size(), 1u);
}

TEST(FitCutoff, FindsThatOfAPowerLaw) {
  for (const double exponent : {0.3, 1.0, 2.0})
    for (const uint64_t unshot : {4'000u, 25'000u}) {
      PowerLaw law(exponent);
      const CutoffFit fit = fit_cutoff({unshot, 1'000'000'000}, std::ref(law));
      const double expected = 0.01 * std::pow(double(unshot) / 10'000, -1 / exponent);
      // The search ends within a standard error of two counts, of 4000 each or more.
      EXPECT_NEAR(std::log(fit.cutoff / expected), 0, 1.05 * std::sqrt(2 / 4000.0) / exponent)
          << exponent << ' ' << unshot;
      EXPECT_TRUE(fit.equal);
      EXPECT_LE(law.tried.size(), 6u);
    }
}

TEST(FitCutoff, SaysWhereNoneIsRight) {
  const auto indifferent = [](double) { return Unshot{500'000, 1'000'000'000}; };
  const CutoffFit many = fit_cutoff({10'000, 1'000'000'000}, indifferent);
  EXPECT_FALSE(many.equal);
  EXPECT_EQ(many.rays.unshot, 500'000u);
  const auto steep = [](double cutoff) { return Unshot{cutoff < 0.02 ? 1'000'000u : 1'000u, 1'000'000'000}; };
  EXPECT_FALSE(fit_cutoff({10'000, 1'000'000'000}, steep).equal);
}

TEST(FitCutoff, NoRayLeftIsNoTrouble) {
  EXPECT_TRUE(fit_cutoff({0, 1000}, [](double) { return Unshot{0, 1000}; }).equal);
}

}  // namespace
}  // namespace frond::compare
