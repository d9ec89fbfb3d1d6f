#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/instruments/patch_comparison.h"
#include "tests/instruments/specimen.h"
#include "tests/support/slow.h"

/// Compares leaf_solved with walks of abm by the goniophotometer: all exitant directions, many walks in single
/// precision. f is integrated over each patch, so that only the walks have noise.
namespace frond::test {
namespace {

struct Setting {
  const char* specimen;
  double theta_deg, lambda_nm;
};

void PrintTo(const Setting& s, std::ostream* out) {
  *out << s.specimen << " at " << s.theta_deg << " degrees, " << s.lambda_nm << " nm";
}

/// FROND_PATCH_RAYS in place of 1e8, or of 1e6 where tests are to be quick.
int64_t rays_each() {
  if (const char* wish = std::getenv("FROND_PATCH_RAYS")) return std::llround(std::strtod(wish, nullptr));
  return slow_tests() ? 100'000'000 : 1'000'000;
}

/// Both leaves, both sides; quick tests take one wavelength.
std::vector<Setting> settings() {
  const std::vector<double> nm = slow_tests() ? std::vector{455.0, 551.0, 608.0, 800.0} : std::vector{551.0};
  std::vector<Setting> all;
  for (const char* specimen : {"soybean", "maize"})
    for (const double theta : {30.0, 60.0, 80.0, 150.0, 120.0, 100.0})
      for (const double lambda_nm : nm) all.push_back({specimen, theta, lambda_nm});
  return all;
}

/// By other seeds, a sound program would exceed 5.2 standard errors in one of 48 x 800 patches in less than 0.8 % of
/// them, and the limit of one of 48 chi-squares in 1 %.
constexpr double kLargest = 5.2, kFalseAlarms = 0.01;

GoniophotometerMeasurement integrated(const Setting& s, double tolerance, const DetectorSphere& sphere,
                                      const ThreadPool& pool) {
  const Prepared leaf("leaf_solved", {word("specimen", s.specimen), real("tolerance", tolerance)}, s.lambda_nm);
  return integrate_f(leaf.under(s.theta_deg), sphere, pool);
}

void record(const std::string& name, const PatchComparison& c) {
  const auto tell = [&](const std::string& what, double value) {
    testing::Test::RecordProperty(name + what, fmt::format("{:.5g}", value));
  };
  tell("chi_square", c.chi_square.statistic), tell("freedom", c.chi_square.freedom), tell("p", c.chi_square.p);
  tell("largest", c.largest), tell("l2", c.l2), tell("l2_noise", c.l2_noise);
}

/// Against a fine table, so that the solution itself is under test; the deviation of the default table is reported too.
void expect_walks_fill_patches(const Setting& s, int64_t rays, size_t tests) {
  const ThreadPool pool;
  const DetectorSphere sphere(20, 40);
  const Prepared walks("abm", {word("specimen", s.specimen)}, s.lambda_nm);
  const GoniophotometerMeasurement walked = measure_f(walks.under(s.theta_deg, 11), sphere, rays, pool);
  const PatchComparison fine = compare(walked, integrated(s, 1e-5, sphere, pool));
  EXPECT_LT(fine.largest, kLargest);
  EXPECT_GT(fine.chi_square.p, sidak_level(kFalseAlarms, tests))
      << fine.chi_square.statistic << " of " << fine.chi_square.freedom;
  record("", fine);
  record("default_", compare(walked, integrated(s, 5e-4, sphere, pool)));
  testing::Test::RecordProperty("leaf", s.specimen);
  testing::Test::RecordProperty("theta_deg", fmt::format("{}", s.theta_deg));
  testing::Test::RecordProperty("nm", fmt::format("{}", s.lambda_nm));
  testing::Test::RecordProperty("rays", fmt::format("{:.0e}", static_cast<double>(rays)));
}

class SolvedLeafAgainstWalks : public testing::TestWithParam<Setting> {};

TEST_P(SolvedLeafAgainstWalks, HasTheFOfEveryPatch) {
  expect_walks_fill_patches(GetParam(), rays_each(), settings().size());
}

INSTANTIATE_TEST_SUITE_P(Goniophotometer, SolvedLeafAgainstWalks, testing::ValuesIn(settings()));

constexpr Setting kLong[] = {{"soybean", 60, 551}, {"maize", 60, 551}};

class SolvedLeafAgainstMoreWalks : public testing::TestWithParam<Setting> {};

TEST_P(SolvedLeafAgainstMoreWalks, HasTheFOfEveryPatch) {
  if (!slow_tests()) GTEST_SKIP() << "takes minutes; FROND_SLOW_TESTS=1 runs it";
  expect_walks_fill_patches(GetParam(), 10 * rays_each(), std::size(kLong));
}

INSTANTIATE_TEST_SUITE_P(Goniophotometer, SolvedLeafAgainstMoreWalks, testing::ValuesIn(kLong));

}  // namespace
}  // namespace frond::test
