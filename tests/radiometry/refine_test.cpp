// Measurements that end when their error is small enough: their errors must be honest although the end depends on them.

#include "jobs/support/refine.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/math/random.h"
#include "radiometry/brf.h"
#include "scene/format/parser.h"
#include "scene/format/plugin_text.h"
#include "tests/support/input_error.h"
#include "tests/support/slow.h"

namespace frond {
namespace {

/// Squares above soil, seen from above: about 1.5 relative variance of a path.
std::string squares() {
  std::string text =
      "LightSource \"distant\" \"point3 from\" [-0.5 0 0.866] \"point3 to\" [0 0 0] \"spectrum L\" \"stdillum-E\"\n"
      "Material \"diffuse\" \"spectrum reflectance\" [800 0.05 801 0.05]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0]\n"
      "Material \"diffusetransmission\" \"spectrum reflectance\" [800 0.5 801 0.5] \"spectrum transmittance\" [800 0.4 "
      "801 0.4]\n";
  RandomStream random(1);
  for (int i = 0; i < 60; ++i) {
    const float x = random.uniform(), y = random.uniform(), z = random.uniform(),
                slope = 0.2f * random.uniform() - 0.1f;
    text += fmt::format("Shape \"bilinearmesh\" \"point3 P\" [{0} {1} {2}  {3} {1} {4}  {0} {5} {2}  {3} {5} {4}]\n", x,
                        y, z, x + 0.1f, z + slope, y + 0.1f);
  }
  return text;
}

class Refinement : public ::testing::Test {
 protected:
  Refinement() : folder_("refinement"), session_(silent_log(), {2, {}, {}}) {
    description_ = parse_scene(folder_.write("scene.pbrt", "WorldBegin\n" + squares()), silent_log());
    first_.emplace(session_, description_, request_);
  }
  /// Measures with a seed until the relative error is at most `rms`; 0: with `samples` for each row.
  BrfMeasurement measured(double seed, double rms, uint64_t samples = 16) {
    SceneDescription description = description_;
    set_param(description.options, parsed_numbers("integer", "seed", {seed}));
    const BrfMeter meter(session_, std::move(description), request_, &first_->scene().scene());
    RenderPart part = meter.scene().empty_part();
    (void)refine(
        {samples, uint64_t{1} << 20, rms, true}, 0, {},
        [&](uint64_t amount) {
          session_.render(meter.scene(), {0, amount}, part);
        },
        [&] { return meter.read(part.film).relative_error(); });
    return meter.read(part.film);
  }

 private:
  TestFolder folder_;
  Session session_;
  SceneDescription description_;
  BrfRequest request_{.views = {{0, 0}}, .period = std::array{1.0, 1.0}, .wavelengths = "bands,wavelengths=800"};
  std::optional<BrfMeter> first_;
};

/// 24 seeds, or 1,000 of the slow tests. False alarms, had the seeds not been fixed: 2e-4 of the few; of the many 2 %
/// for the coverage, 1e-4 for the rest.
TEST_F(Refinement, ErrorsAreHonestWhereTheyEndTheMeasurement) {
  const int seeds = slow_tests() ? 1000 : 24;
  constexpr double kRms = 0.0125;
  const MeanError truth = measured(1e6, 0, slow_tests() ? 1 << 15 : 1 << 10).at(0, 0);
  double sum = 0, sum_of_squares = 0, deviations = 0, covered = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const BrfMeasurement m = measured(seed, kRms);
    const MeanError& v = m.at(0, 0);
    EXPECT_LE(m.relative_error(), kRms);
    EXPECT_GT(m.relative_error(), (slow_tests() ? 0.65 : 0.7) * kRms);
    const double z = (v.mean - truth.mean) / std::hypot(v.standard_error, truth.standard_error);
    sum += z, sum_of_squares += z * z, covered += std::abs(z) < 1.96 ? 1 : 0;
    deviations += std::pow(v.mean / truth.mean - 1, 2);
  }
  RecordProperty("coverage", fmt::format("{:.4f}", covered / seeds));
  RecordProperty("rms_error", fmt::format("{:.5f}", std::sqrt(deviations / seeds)));
  RecordProperty("mean_z", fmt::format("{:.4f}", sum / seeds));
  EXPECT_LT(std::abs(sum / seeds), 3.9 / std::sqrt(seeds)) << "the end biases the mean";
  const double slack = 4 * std::sqrt(2.0 / seeds);
  EXPECT_GT(sum_of_squares / seeds, std::max(0.3, 1 - slack));
  EXPECT_LT(sum_of_squares / seeds, 1.05 + slack);
  if (!slow_tests()) return;
  EXPECT_GT(covered / seeds, 0.93);
  EXPECT_LT(covered / seeds, 0.97);
  // Of exactly as many paths as are needed the error is the requested one. Measured: 0.93 and 0.91 of it with two sets
  // of random numbers, so 1.15 and 1.21 times the paths; ± 0.022 (one standard error). False alarms: 1e-3.
  EXPECT_NEAR(std::sqrt(deviations / seeds) / kRms, 0.92, 0.075);
}

TEST(NextAmount, HasEightStepsToTheDouble) {
  for (uint64_t amount = 64; amount < 1 << 20; amount *= 2) {
    uint64_t next = amount;
    for (int step = 0; step < 8; ++step) next = next_amount(next);
    EXPECT_EQ(next, 2 * amount);
  }
  EXPECT_EQ(next_amount(16), 24u);
}

/// Steps of next_amount from `first` to `last`; 0: `last` is none of them.
int steps(uint64_t first, uint64_t last) {
  int count = 0;
  for (; first < last; first = next_amount(first)) ++count;
  return first == last ? count : 0;
}

TEST(NextCheck, LeavesAQuarterOfWhatIsMissing) {
  EXPECT_EQ(next_check(32, 2), 104u);  // 32 + 3/4 of 96
  for (const double ratio : {5.0, 1e300, double(INFINITY)}) EXPECT_EQ(next_check(64, ratio), 256u);
  for (uint64_t amount = 8; amount < 1 << 20; amount += amount / 3 / 8 * 8 + 8)
    for (const double ratio : {1.001, 1.05, 1.2, 1.7, 2.0}) {
      const uint64_t next = next_check(std::bit_floor(amount), ratio), first = std::bit_floor(amount);
      const double most = double(first) * (1 + 0.75 * (ratio * ratio - 1));
      ASSERT_GE(steps(first, next), 1);
      EXPECT_TRUE(double(next) <= most || next == next_amount(first)) << first << ' ' << ratio;
      EXPECT_GT(double(next_amount(next)), most);
    }
}

/// With an error that differs from what amounts predict by up to a fifth.
TEST(Refine, AnInterruptedOneEndsAtTheSameAmount) {
  const RefineLimits limits{8, uint64_t{1} << 32, 0.01, true};
  const auto error = [](uint64_t amount) {
    return 0.37 / std::sqrt(double(amount)) * (1 + 0.2 * std::sin(double(amount)));
  };
  const auto ended = [&](uint64_t present, std::vector<uint64_t>& checked) {
    uint64_t now = 0;
    EXPECT_EQ(
        refine(
            limits, present, {}, [&](uint64_t amount) { checked.push_back(now = amount); }, [&] { return error(now); }),
        RefineEnd::done);
    return now;
  };
  std::vector<uint64_t> checked, rest;
  const uint64_t end = ended(0, checked);
  EXPECT_LT(checked.size(), 12u);
  for (const uint64_t present : checked) EXPECT_EQ(ended(present, rest), end);
}

}  // namespace
}  // namespace frond
