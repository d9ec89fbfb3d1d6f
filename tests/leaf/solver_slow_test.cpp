#include <gtest/gtest.h>

#include <bit>
#include <mutex>
#include <numbers>

#include "core/parallel.h"
#include "leaf/solve/solver.h"
#include "leaf/table/table.h"
#include "leaf/tissue/specimens.h"
#include "leaf/walk/batch_walk.h"
#include "tests/support/slow.h"

/// The solution against weighted walks in great number: minutes on all cores, so only where FROND_SLOW_TESTS is 1.
namespace frond::leaf {
namespace {

constexpr double kStandardError = 5e-5;
constexpr int kBatch = 1 << 14;

/// Sums of weights and of their squares.
struct Sums {
  double subsurface = 0, subsurface2 = 0, transmitted = 0, transmitted2 = 0;
  int64_t rays = 0;

  void add(std::span<const BatchRay> batch) {
    for (const BatchRay& ray : batch) {
      const double w = double(ray.weight), reflected = ray.fate == Fate::reflected ? w : 0;
      const double through = ray.fate == Fate::transmitted ? w : 0;
      subsurface += reflected, subsurface2 += reflected * reflected;
      transmitted += through, transmitted2 += through * through;
    }
    rays += static_cast<int64_t>(batch.size());
  }
  void add(const Sums& other) {
    subsurface += other.subsurface, subsurface2 += other.subsurface2;
    transmitted += other.transmitted, transmitted2 += other.transmitted2;
    rays += other.rays;
  }
};

double mean(double sum, int64_t rays) { return sum / static_cast<double>(rays); }
double standard_error(double sum, double sum2, int64_t rays) {
  const double m = mean(sum, rays);
  return std::sqrt((mean(sum2, rays) - m * m) / static_cast<double>(rays));
}

/// `batches` batches from number `first` on, each with its own rays, which no other angle and leaf shares: shared rays
/// would correlate their errors.
Sums walk_many(const Tissue& tissue, double theta_deg, int64_t first, int64_t batches, const ThreadPool& pool) {
  const uint64_t key = hash_key(std::bit_cast<uint64_t>(theta_deg), std::bit_cast<uint64_t>(tissue.optical_depth[2]));
  const double theta = theta_deg * std::numbers::pi / 180;
  const Vec3d wo{std::sin(theta), 0, std::cos(theta)};
  Sums all;
  std::mutex mutex;
  pool.for_each(batches, [&](int64_t i, int) {
    std::array<BatchRay, kBatch> batch;
    walk_batch(tissue, wo, Absorption::weighted, key, batch, static_cast<uint64_t>((first + i) * kBatch));
    Sums sums;
    sums.add(batch);
    const std::lock_guard lock(mutex);
    all.add(sums);
  });
  return all;
}

/// Walks until both standard errors are reached.
Sums walk_to_the_end(const Tissue& tissue, double theta_deg, const ThreadPool& pool) {
  constexpr int64_t kPilot = 16;
  Sums sums = walk_many(tissue, theta_deg, 0, kPilot, pool);
  for (int64_t done = kPilot;;) {
    const double worst = std::max(standard_error(sums.subsurface, sums.subsurface2, sums.rays),
                                  standard_error(sums.transmitted, sums.transmitted2, sums.rays));
    if (worst <= kStandardError) return sums;
    const double needed = static_cast<double>(done) * worst * worst / (kStandardError * kStandardError);
    const auto more = static_cast<int64_t>(std::ceil(1.02 * needed)) - done;
    sums.add(walk_many(tissue, theta_deg, done, more, pool));
    done += more;
  }
}

struct Case {
  const char* specimen;
  double lambda_nm;
};

class SolverAgainstWalks : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (!slow_tests()) GTEST_SKIP() << "takes minutes; FROND_SLOW_TESTS=1 runs it";
  }
  /// No side and no angle is favoured: over all cases the differences even out.
  static void TearDownTestSuite() {
    constexpr double kLargestMean = 1e-5;
    if (compared_ < 4 * 70) return;  // of a few alone the standard error is too large
    EXPECT_LT(std::abs(sum_ / compared_), kLargestMean);
    RecordProperty("mean_difference", std::to_string(sum_ / compared_));
  }

  static void compare(double walked, double error, double solved, double theta_deg) {
    constexpr double kLimit = 4.3;  // in standard errors: over all cases a false alarm once in a hundred seeds
    EXPECT_LT(std::abs(walked - solved), kLimit * error) << "at " << theta_deg;
    sum_ += walked - solved, compared_ += 1;
  }

  static inline double sum_ = 0, compared_ = 0;
};

TEST_P(SolverAgainstWalks, AgreesAtEveryAngleOnBothSides) {
  const TissueModel model(find_specimen(GetParam().specimen)->params);
  const Tissue tissue = model.at(GetParam().lambda_nm);
  const ThreadPool pool;
  for (const double theta_deg : even_steps(0, 180, 5)) {
    const Shares solved = solve(tissue, std::array{theta_deg})[0];
    if (theta_deg == 90) {  // along the leaf nothing can be walked: the limit
      EXPECT_EQ(solved, (Shares{1, 0, 0}));
      continue;
    }
    const Sums s = walk_to_the_end(tissue, theta_deg, pool);
    compare(mean(s.subsurface, s.rays), standard_error(s.subsurface, s.subsurface2, s.rays), solved.subsurface,
            theta_deg);
    compare(mean(s.transmitted, s.rays), standard_error(s.transmitted, s.transmitted2, s.rays), solved.transmitted,
            theta_deg);
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, SolverAgainstWalks,
                         testing::Values(Case{"soybean", 455}, Case{"soybean", 551}, Case{"soybean", 608},
                                         Case{"soybean", 800}, Case{"maize", 455}, Case{"maize", 551},
                                         Case{"maize", 608}, Case{"maize", 800}),
                         [](const auto& instance) {
                           return instance.param.specimen + std::to_string(int(instance.param.lambda_nm));
                         });

}  // namespace
}  // namespace frond::leaf
