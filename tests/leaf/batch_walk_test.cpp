#include "leaf/walk/batch_walk.h"

#include <gtest/gtest.h>

#include <bit>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <numbers>
#include <vector>

#include "leaf/solve/solver.h"
#include "leaf/tissue/specimens.h"
#include "tests/leaf/plain_walk.h"
#include "tests/leaf/statistics.h"
#include "tests/support/slow.h"

namespace frond::leaf {
namespace {

using test::Estimate;
using test::kFalseAlarm;
using test::PlainWalk;

Vec3d incidence(double theta_deg) {
  const double theta = theta_deg * std::numbers::pi / 180;
  return {std::sin(theta), 0, std::cos(theta)};
}

TissueModel model_of(std::string_view specimen, bool sieve_and_detour = false) {
  TissueParams params = find_specimen(specimen)->params;
  params.sieve_and_detour = sieve_and_detour;
  return TissueModel(params);
}

std::vector<BatchRay> batch(const Tissue& tissue, const Vec3d& wo, Absorption absorption, size_t rays,
                            uint64_t key = 1) {
  std::vector<BatchRay> out(rays);
  walk_batch(tissue, wo, absorption, key, out);
  return out;
}

/// Number of rays by fate.
using Counts = std::array<int64_t, 4>;

int64_t count(const Counts& counts, Fate fate) { return counts[static_cast<size_t>(fate)]; }

void add(Counts& counts, std::span<const BatchRay> rays) {
  for (const BatchRay& ray : rays) ++counts[static_cast<size_t>(ray.fate)];
}

Counts batch_counts(const Tissue& tissue, const Vec3d& wo, size_t rays) {
  Counts counts{};
  add(counts, batch(tissue, wo, Absorption::analog, rays));
  return counts;
}

Counts plain_counts(const Tissue& tissue, const Vec3d& wo, int rays) {
  Counts counts{};
  PlainWalk walk(tissue, 2);
  for (int i = 0; i < rays; ++i) ++counts[static_cast<size_t>(walk(wo).fate)];
  return counts;
}

/// Two-sided, exact but for `slack`, up to which the true share may lie from `share`.
double binomial_p(int64_t successes, int64_t trials, double share, double slack) {
  const double n = static_cast<double>(trials), k = static_cast<double>(successes);
  const double nearest = std::clamp(std::clamp(k / n, share - slack, share + slack), 0.0, 1.0);
  const boost::math::binomial distribution(n, nearest);
  const double below = cdf(distribution, k), above = k > 0 ? cdf(complement(distribution, k - 1)) : 1;
  return std::min(1.0, 2 * std::min(below, above));
}

/// p-value of "the two were drawn from one distribution" (Pearson's test of homogeneity). Classes with fewer than 10 in
/// all go together.
double homogeneity_p(std::span<const int64_t> a, std::span<const int64_t> b) {
  double total_a = 0, total_b = 0;
  for (size_t i = 0; i < a.size(); ++i) total_a += double(a[i]), total_b += double(b[i]);
  double statistic = 0, rest_a = 0, rest_b = 0;
  int classes = 0;
  const auto add_class = [&](double x, double y) {
    const double expected_x = (x + y) * total_a / (total_a + total_b), expected_y = x + y - expected_x;
    statistic += (x - expected_x) * (x - expected_x) / expected_x + (y - expected_y) * (y - expected_y) / expected_y;
    ++classes;
  };
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i] + b[i] >= 10) {
      add_class(double(a[i]), double(b[i]));
    } else {
      rest_a += double(a[i]), rest_b += double(b[i]);
    }
  }
  if (rest_a + rest_b > 0) add_class(rest_a, rest_b);
  return classes < 2 ? 1 : cdf(complement(boost::math::chi_squared(classes - 1), statistic));
}

bool same_bits(const BatchRay& a, const BatchRay& b) {
  const auto bits = [](float x) { return std::bit_cast<uint32_t>(x); };
  return a.fate == b.fate && bits(a.weight) == bits(b.weight) && bits(a.wi.x) == bits(b.wi.x) &&
         bits(a.wi.y) == bits(b.wi.y) && bits(a.wi.z) == bits(b.wi.z);
}

void expect_same_bits(std::span<const BatchRay> a, std::span<const BatchRay> b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) ASSERT_TRUE(same_bits(a[i], b[i])) << i;
}

TEST(WalkBatch, IsTheSameToTheBitWithAnyInstructions) {
  for (const char* specimen : {"soybean", "maize"})
    for (const bool sieve : {false, true})
      for (const Absorption absorption : {Absorption::analog, Absorption::weighted})
        for (const double theta : {0.0, 45.0, 89.0, 172.0}) {
          const TissueModel model = model_of(specimen, sieve);
          const Tissue tissue = model.at(608);
          const std::vector<BatchRay> widest = batch(tissue, incidence(theta), absorption, 5000);
          for (const batch::Kernel* kernel : batch_kernels()) {
            SCOPED_TRACE(std::string(name_of(*kernel)) + " " + specimen);
            std::vector<BatchRay> rays(widest.size());
            walk_batch(*kernel, tissue, incidence(theta), absorption, 1, rays);
            expect_same_bits(widest, rays);
          }
        }
}

TEST(WalkBatch, ARayDependsOnItsNumberAndNotOnTheOthers) {
  const TissueModel model = model_of("maize");
  const Tissue tissue = model.at(800);
  const std::vector<BatchRay> whole = batch(tissue, incidence(30), Absorption::analog, 500);
  for (const size_t first : {0u, 1u, 100u, 499u})
    for (const size_t size : {0u, 1u, 15u, 63u, 64u, 65u, 400u}) {
      if (first + size > whole.size()) continue;
      std::vector<BatchRay> part(size);
      walk_batch(tissue, incidence(30), Absorption::analog, 1, part, first);
      expect_same_bits(part, std::span(whole).subspan(first, size));
    }
}

TEST(WalkBatch, AnotherKeyGivesOtherRays) {
  const TissueModel model = model_of("soybean");
  const Tissue tissue = model.at(800);
  const auto a = batch(tissue, incidence(30), Absorption::analog, 100, 1);
  const auto b = batch(tissue, incidence(30), Absorption::analog, 100, 2);
  int same = 0;
  for (size_t i = 0; i < a.size(); ++i) same += a[i].wi == b[i].wi && a[i].fate != Fate::absorbed;
  EXPECT_LE(same, 1);
}

struct Case {
  std::string_view specimen;
  bool sieve;
  double lambda_nm;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const std::string_view specimen : {"soybean", "maize"})
    for (const bool sieve : {false, true})
      for (const double nm : {455.0, 551.0, 800.0}) all.push_back({specimen, sieve, nm});
  return all;
}

const std::vector<double> kAngles{0, 8, 45, 80, 89, 100, 172};

/// Calls body(tissue, theta_deg) for every case and angle.
template <class Body>
void for_each_case(const Body& body) {
  for (const Case& c : cases()) {
    const TissueModel model = model_of(c.specimen, c.sieve);
    const Tissue tissue = model.at(c.lambda_nm);
    for (size_t angle = 0; angle < kAngles.size(); ++angle) {
      SCOPED_TRACE(testing::Message() << c.specimen << " sieve " << c.sieve << " " << c.lambda_nm << " nm "
                                      << kAngles[angle] << " degrees");
      body(tissue, angle);
    }
  }
}

/// The largest error of a solution, leaf/solve/solver.h.
constexpr double kSolverError = 2e-6;

TEST(WalkBatch, CountsAreAsSolved) {
  const int runs = slow_tests() ? 100 : 1;
  std::vector<BatchRay> rays(100000);
  const double comparisons = 3.0 * static_cast<double>(cases().size() * kAngles.size());
  const double level = -std::expm1(std::log1p(-kFalseAlarm) / comparisons);
  std::vector<Shares> solved;
  for_each_case([&](const Tissue& tissue, size_t angle) {
    if (angle == 0) solved = solve(tissue, kAngles);
    Counts counts{};
    for (int run = 0; run < runs; ++run) {
      const uint64_t first = static_cast<uint64_t>(run) * rays.size();
      walk_batch(tissue, incidence(kAngles[angle]), Absorption::analog, 3, rays, first);
      add(counts, rays);
    }
    const auto p = [&](Fate fate, double share) {
      return binomial_p(count(counts, fate), runs * static_cast<int64_t>(rays.size()), share, kSolverError);
    };
    EXPECT_GT(p(Fate::surface, solved[angle].surface), level);
    EXPECT_GT(p(Fate::reflected, solved[angle].subsurface), level);
    EXPECT_GT(p(Fate::transmitted, solved[angle].transmitted), level);
  });
}

/// Returns estimates of the shares reflected by the tissue and transmitted.
std::array<Estimate, 2> means(std::span<const BatchRay> rays) {
  std::array<Estimate, 2> e;
  for (const BatchRay& ray : rays) {
    e[0].add(ray.fate == Fate::reflected ? double(ray.weight) : 0);
    e[1].add(ray.fate == Fate::transmitted ? double(ray.weight) : 0);
  }
  return e;
}

TEST(WalkBatch, WeightedMeansAreThoseOfAnalogWalks) {
  const double limit = test::z_limit(static_cast<int>(2 * cases().size() * kAngles.size()));
  for_each_case([&](const Tissue& tissue, size_t angle) {
    const Vec3d wo = incidence(kAngles[angle]);
    const auto analog = means(batch(tissue, wo, Absorption::analog, 50000, 4));
    const auto weighted = means(batch(tissue, wo, Absorption::weighted, 50000, 5));
    EXPECT_LT(std::abs(test::z_score(analog[0], weighted[0])), limit);
    EXPECT_LT(std::abs(test::z_score(analog[1], weighted[1])), limit);
  });
}

/// Bins of equal solid angle over the sphere, and one more for absorbed rays.
class DirectionBins {
 public:
  static constexpr size_t kHeights = 20, kAzimuths = 12;

  void add(Fate fate, const Vec3d& wi) {
    if (fate == Fate::absorbed) return ++counts_.back(), void();
    const double height = (wi.z + 1) / 2 * kHeights;
    const double azimuth = (std::atan2(wi.y, wi.x) / std::numbers::pi + 1) / 2 * kAzimuths;
    const size_t h = std::min(static_cast<size_t>(height), kHeights - 1);
    ++counts_[h * kAzimuths + std::min(static_cast<size_t>(azimuth), kAzimuths - 1)];
  }
  std::span<const int64_t> counts() const { return counts_; }

 private:
  std::array<int64_t, kHeights * kAzimuths + 1> counts_{};
};

// Where light leaves to, against the plain loop; wo lies off the x-z plane, so that a turned azimuth would show.
TEST(WalkBatch, DirectionsAreDistributedAsThePlainWalks) {
  struct {
    Case leaf;
    double theta_deg;
  } const kCases[] = {{{"soybean", false, 800}, 30}, {{"soybean", false, 551}, 70}, {{"soybean", false, 800}, 70},
                      {{"soybean", true, 800}, 130}, {{"maize", false, 800}, 30},   {{"maize", false, 551}, 70}};
  const int rays = slow_tests() ? 3000000 : 100000;
  for (const auto& [leaf, theta] : kCases) {
    const TissueModel model = model_of(leaf.specimen, leaf.sieve);
    const Tissue tissue = model.at(leaf.lambda_nm);
    const Vec3d in_plane = incidence(theta), wo{in_plane.x * 0.28, in_plane.x * 0.96, in_plane.z};
    DirectionBins plain, batched;
    PlainWalk walk(tissue, 6);
    for (int i = 0; i < rays; ++i) {
      const WalkEnd end = walk(wo);
      plain.add(end.fate, end.wi);
    }
    for (const BatchRay& ray : batch(tissue, wo, Absorption::analog, static_cast<size_t>(rays), 7))
      batched.add(ray.fate, {ray.wi.x, ray.wi.y, ray.wi.z});
    EXPECT_GT(homogeneity_p(plain.counts(), batched.counts()), kFalseAlarm / std::size(kCases))
        << leaf.specimen << " " << leaf.lambda_nm << " nm " << theta;
  }
}

TEST(WalkBatch, DirectionsAreUnitAndOnTheirSide) {
  for (const char* specimen : {"soybean", "maize"})
    for (const double theta : {0.0, 70.0, 89.999, 110.0, 180.0}) {
      const TissueModel model = model_of(specimen);
      const Vec3d wo = incidence(theta);
      for (const BatchRay& ray : batch(model.at(800), wo, Absorption::weighted, 20000)) {
        ASSERT_EQ(ray.weight == 0, ray.fate == Fate::absorbed);
        if (ray.fate == Fate::absorbed) continue;
        ASSERT_NEAR(length(ray.wi), 1, 1e-6);
        ASSERT_NE(ray.wi.z, 0);
        ASSERT_EQ(ray.wi.z * wo.z < 0, ray.fate == Fate::transmitted);
      }
    }
}

TEST(WalkBatch, LeafThatAbsorbsNothingLosesNoRay) {
  for (const double exponent : {-1.0, 0.0, 1000.0})  // -1: the specimen's own
    for (const char* specimen : {"soybean", "maize"})
      for (const Absorption absorption : {Absorption::analog, Absorption::weighted})
        for (const double theta : {0.0, 45.0, 89.99, 91.0, 170.0}) {
          TissueParams p = find_specimen(specimen)->params;
          p.mesophyll_fraction = 0;
          if (exponent >= 0) p.cuticle_aspect = p.epidermis_aspect = p.spongy_aspect = p.palisade_aspect = exponent;
          const TissueModel model(p);
          for (const BatchRay& ray : batch(model.at(800), incidence(theta), absorption, 5000))
            ASSERT_EQ(ray.weight, 1) << specimen << " " << theta;
        }
}

void expect_as_plain(const Tissue& tissue, const Vec3d& wo, const std::string& what) {
  constexpr int kRays = 10000;
  EXPECT_GT(homogeneity_p(plain_counts(tissue, wo, kRays), batch_counts(tissue, wo, kRays)), kFalseAlarm) << what;
}

TEST(WalkBatch, ExtremeExponentsAndDepthsAreAsThePlainWalks) {
  for (const double exponent : {0.0, 0.2, 1000.0})
    for (const double thickness : {0.0, 1e-2, 1e30})
      for (const Structure structure : {Structure::bifacial, Structure::unifacial}) {
        TissueParams p = find_specimen("soybean")->params;
        p.structure = structure;
        p.thickness_m = thickness;
        p.cuticle_aspect = p.epidermis_aspect = p.spongy_aspect = p.palisade_aspect = exponent;
        const TissueModel model(p);
        for (const double theta : {0.0, 60.0, 89.9, 120.0})
          expect_as_plain(model.at(800), incidence(theta), std::to_string(exponent) + " " + std::to_string(thickness));
      }
}

TEST(WalkBatch, InfiniteDepthLetsNothingThrough) {
  for (const char* specimen : {"soybean", "maize"})
    for (const Absorption absorption : {Absorption::analog, Absorption::weighted}) {
      const TissueModel model = model_of(specimen);
      Tissue tissue = model.at(551);
      for (double& depth : tissue.optical_depth)
        if (depth > 0) depth = std::numeric_limits<double>::infinity();
      for (const BatchRay& ray : batch(tissue, incidence(30), absorption, 5000))
        ASSERT_TRUE(ray.fate != Fate::transmitted && std::isfinite(length(ray.wi)));
    }
}

using Indices = std::array<double, Tissue::kMedia>;

// Equal, below 1, far apart, and hardly different: total reflection then begins close to grazing.
TEST(WalkBatch, UnusualIndicesAreAsThePlainWalks) {
  constexpr Indices kIndices[] = {{1, 1, 1, 1, 1, 1, 1},
                                  {1, 1.4, 1.4, 1, 1.4, 1.4, 1},
                                  {1, 0.8, 1.4, 1, 0.7, 0.8, 1},
                                  {1, 4, 1.01, 1, 2.5, 4, 1},
                                  {1, 1 + 1e-6, 1 + 2e-6, 1, 1 + 1e-7, 1 + 1e-6, 1}};
  for (const char* specimen : {"soybean", "maize"})
    for (const Indices& n : kIndices)
      for (const double theta : {0.0, 45.0, 53.13010235415598, 89.0, 100.0}) {  // 53.13: critical for 0.8
        const TissueModel model = model_of(specimen);
        Tissue tissue = model.at(800);
        tissue.n = n;
        if (tissue.air_space_moves) tissue.n[4] = n[2];
        expect_as_plain(tissue, incidence(theta), testing::PrintToString(n) + std::to_string(theta));
      }
}

TEST(WalkBatch, EqualIndicesLetAllThrough) {
  const TissueModel model = model_of("soybean");
  Tissue tissue = model.at(800);
  tissue.n.fill(1);
  tissue.optical_depth.fill(0);
  for (const double theta : {0.0, 60.0, 89.9, 180.0})
    EXPECT_EQ(count(batch_counts(tissue, incidence(theta), 10000), Fate::transmitted), 10000) << theta;
}

// A stack of smooth plates: light leaves along its first direction or the mirror's.
TEST(WalkBatch, WithoutLobesDirectionsAreIdeal) {
  const TissueModel model = model_of("soybean");
  Tissue tissue = model.at(800);
  const InterfaceLobes smooth{};
  tissue.lobes = &smooth;
  for (const Vec3d& wo : {Vec3d{0.48, 0.64, 0.6}, Vec3d{0, 0, -1}, Vec3d{-0.6, 0, -0.8}}) {
    for (const BatchRay& ray : batch(tissue, wo, Absorption::analog, 5000)) {
      if (ray.fate == Fate::absorbed) continue;
      const double side = ray.fate == Fate::transmitted ? -1 : 1;
      // The rounding of some ten events; where a cosine is found from its sine, twice as much.
      ASSERT_NEAR(ray.wi.x, -wo.x, 3e-6);
      ASSERT_NEAR(ray.wi.y, -wo.y, 3e-6);
      ASSERT_NEAR(ray.wi.z, side * wo.z, 3e-6);
    }
    expect_as_plain(tissue, wo, "smooth");
  }
}

// In an antidermal wall of a higher index than both its neighbours, light past both critical angles is trapped: it
// neither leaves nor is absorbed. A wall with weak absorption ends the plain walk with the same shares.
TEST(WalkBatch, LightTrappedForEverEndsAsAbsorbed) {
  const TissueModel model = model_of("soybean");
  Tissue tissue = model.at(800);
  tissue.n = {1, 1.3, 1.4, 1, 1.6, 1.3, 1};
  Tissue absorbing = tissue;
  absorbing.optical_depth[4] = 1e-6;
  constexpr int kRays = 20000;
  const Counts counts = batch_counts(tissue, incidence(120), kRays);
  EXPECT_GT(count(counts, Fate::absorbed), 0);
  EXPECT_GT(homogeneity_p(plain_counts(absorbing, incidence(120), kRays), counts), kFalseAlarm);
}

TEST(WalkBatch, GrazingLightIsReflectedFinitely) {
  const TissueModel model = model_of("soybean");
  for (const double z : {1e-3, 1e-8, -1e-8, 1e-30, -1e-300}) {
    const Vec3d wo{0, std::sqrt(1 - z * z), z};
    for (const BatchRay& ray : batch(model.at(551), wo, Absorption::analog, 2000)) {
      ASSERT_NEAR(length(ray.wi), ray.fate == Fate::absorbed ? 0 : 1, 1e-6);
      ASSERT_TRUE(ray.fate == Fate::surface || z == 1e-3);
    }
  }
}

// Against a change of results that nobody meant: then tables on disk are wrong as well (kWalkVersion).
TEST(WalkBatch, HasAlwaysGivenTheseBits) {
  Tissue tissue{};
  const Lobe cosine(1), narrow(5);
  tissue.n = {1, 1.5, 1.375, 1, 1.25, 1.5, 1};
  tissue.optical_depth = {0, 0, 0.5, 0, 0, 0, 0};
  InterfaceLobes lobes;
  lobes.fill({{{&narrow, &cosine}, {&cosine, nullptr}}});
  tissue.lobes = &lobes;
  uint64_t hash = 0;
  for (const Absorption absorption : {Absorption::analog, Absorption::weighted})
    for (const BatchRay& ray : batch(tissue, {0.6, 0, 0.8}, absorption, 1000))
      for (const float x : {ray.wi.x, ray.wi.y, ray.wi.z, ray.weight})
        hash = hash_key(hash, std::bit_cast<uint32_t>(x));
  EXPECT_EQ(hash, 15193900769429481119u);
}

}  // namespace
}  // namespace frond::leaf
