#include <gtest/gtest.h>

#include <cstdlib>
#include <numbers>
#include <string>

#include "leaf/tissue/specimens.h"
#include "leaf/walk/walk.h"
#include "tests/leaf/statistics.h"

/// Walks that carry several wavelengths, against walks of one.
namespace frond::leaf {
namespace {

using test::Estimate;

Vec3d direction(double theta_deg, double phi) {
  const double theta = theta_deg * std::numbers::pi / 180;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Four wavelengths with very different refraction and absorption.
class Dispersive {
 public:
  explicit Dispersive(std::string_view leaf) : model_(params_of(leaf)) {
    constexpr double kCuticle[] = {1.3, 1.43, 1.57, 1.7}, kMesophyll[] = {1.55, 1.4, 1.33, 1.47};
    constexpr double kWall[] = {1.35, 1.6, 1.45, 1.52}, kDepth[] = {0.2, 2, 0.5, 1};
    for (size_t i = 0; i < kLanes; ++i) {
      Tissue& t = tissues_[i] = model_.at(551);
      t.n[1] = t.n[5] = kCuticle[i];
      t.n[2] = kMesophyll[i];
      t.n[4] = t.air_space_moves ? kMesophyll[i] : kWall[i];
      t.optical_depth[2] = kDepth[i];
      if (t.air_space_moves) t.optical_depth[4] = kDepth[i];
      lanes_[i] = &tissues_[i];
    }
  }
  const Tissue& tissue(size_t lane) const { return tissues_[lane]; }
  std::span<const Tissue* const> lanes() const { return lanes_; }

 private:
  /// "wide": soybean with lobes so wide that the walls cut off much of them, and of each wavelength another share.
  static TissueParams params_of(std::string_view leaf) {
    TissueParams params = find_specimen(leaf == "wide" ? "soybean" : leaf)->params;
    if (leaf == "wide") params.epidermis_aspect = params.spongy_aspect = params.palisade_aspect = 0;
    return params;
  }

  TissueModel model_;
  std::array<Tissue, kLanes> tissues_;
  std::array<const Tissue*, kLanes> lanes_;
};

/// Detectors all over the sphere, narrow towards the horizon.
class Goniophotometer {
 public:
  static constexpr size_t kBands = 12, kSectors = 6, kBins = kBands * kSectors;

  void add(const Vec3d& w, double weight) {
    const double band = (std::copysign(std::sqrt(std::abs(w.z)), w.z) + 1) / 2 * kBands;
    const double sector = (std::atan2(w.y, w.x) / std::numbers::pi + 1) / 2 * kSectors;
    bins_[std::min(static_cast<size_t>(band), kBands - 1) * kSectors +
          std::min(static_cast<size_t>(sector), kSectors - 1)]
        .add(weight);
    ++rays_;
  }
  void add_absorbed() { ++rays_; }
  /// Estimate of a bin; every other ray counts as 0.
  Estimate bin(size_t i) const {
    Estimate e = bins_[i];
    e.add_zeros(rays_ - e.count());
    return e;
  }
  int hits(size_t i) const { return bins_[i].count(); }

 private:
  std::array<Estimate, kBins> bins_;
  int rays_ = 0;
};

/// FROND_HERO_RAYS: for reports, which read the figures that the test records.
int rays() {
  const char* asked = std::getenv("FROND_HERO_RAYS");
  return asked ? static_cast<int>(std::stod(asked)) : 100000;
}

FirstEvent first_event(RandomStream& rng) {
  const double r = std::sqrt(rng.uniform_double()), phi = 2 * std::numbers::pi * rng.uniform_double();
  return {rng.uniform_double(), r * std::cos(phi), r * std::sin(phi)};
}

std::array<Goniophotometer, kLanes> measure_together(const Dispersive& leaf, const Vec3d& wo, Absorption absorption) {
  std::array<Goniophotometer, kLanes> result;
  RandomStream rng(1);
  for (int left = rays(); left > 0; --left) {
    const SpectralWalkEnd end = walk(leaf.lanes(), rng.bits() % kLanes, wo, absorption, first_event(rng), rng);
    for (size_t lane = 0; lane < kLanes; ++lane)
      end.fate == Fate::absorbed ? result[lane].add_absorbed() : result[lane].add(end.wi, end.weight[lane]);
  }
  return result;
}

Goniophotometer measure_alone(const Tissue& tissue, const Vec3d& wo, Absorption absorption) {
  Goniophotometer result;
  RandomStream rng(2);
  for (int left = rays(); left > 0; --left) {
    const WalkEnd end = walk(tissue, wo, absorption, rng);
    end.fate == Fate::absorbed ? result.add_absorbed() : result.add(end.wi, end.weight);
  }
  return result;
}

class SpectralWalk : public testing::TestWithParam<std::tuple<const char*, Absorption, double>> {};

// Every direction is right at every wavelength, not only how much leaves in all.
TEST_P(SpectralWalk, FillsTheDetectorsAsWalksOfOneWavelengthDo) {
  const auto& [specimen, absorption, theta_deg] = GetParam();
  const Dispersive leaf(specimen);
  const Vec3d wo = direction(theta_deg, 0.3);
  const auto together = measure_together(leaf, wo, absorption);
  const double limit = test::z_limit(kLanes * 18);
  int all_compared = 0;
  double all_squares = 0, largest = 0;
  for (size_t lane = 0; lane < kLanes; ++lane) {
    const Goniophotometer alone = measure_alone(leaf.tissue(lane), wo, absorption);
    int compared = 0;
    double chi_square = 0;
    for (size_t i = 0; i < Goniophotometer::kBins; ++i) {
      if (alone.hits(i) < 100) continue;  // too few for a normal distribution
      ++compared;
      const double z = test::z_score(alone.bin(i), together[lane].bin(i));
      chi_square += z * z;
      largest = std::max(largest, std::abs(z));
    }
    EXPECT_GT(compared, 15);
    EXPECT_LT(test::z_of_chi_square(chi_square, compared), limit) << "lane " << lane << ": " << chi_square;
    all_compared += compared;
    all_squares += chi_square;
  }
  RecordProperty("leaf", specimen);
  RecordProperty("absorption", absorption == Absorption::analog ? "analog" : "weighted");
  RecordProperty("theta_deg", std::to_string(static_cast<int>(theta_deg)));
  RecordProperty("rays", std::to_string(rays()));
  RecordProperty("comparisons", std::to_string(all_compared));
  RecordProperty("chi_square", std::to_string(all_squares));
  RecordProperty("largest", std::to_string(largest));
}

INSTANTIATE_TEST_SUITE_P(Dispersion, SpectralWalk,
                         testing::Combine(testing::Values("soybean", "maize", "wide"),
                                          testing::Values(Absorption::analog, Absorption::weighted),
                                          testing::Values(35.0, 70.0, 115.0)));

TEST(SpectralSubsurfaceF, HasTheMeanOfEachWavelengthsOwn) {
  constexpr int kPairs = 5, kSamples = 30000;
  const double limit = test::z_limit(2 * 2 * kPairs * kLanes);
  const Vec3d wo = direction(40, 0.3);
  const Vec3d wis[kPairs] = {direction(10, 0), direction(60, 3), direction(85, 1), direction(120, 2),
                             direction(175, 0)};
  for (const char* specimen : {"soybean", "maize"}) {
    const Dispersive leaf(specimen);
    for (const Absorption absorption : {Absorption::analog, Absorption::weighted})
      for (const Vec3d& wi : wis) {
        std::array<Estimate, kLanes> together, alone;
        RandomStream rng(3);
        for (int i = 0; i < kSamples; ++i) {
          const LaneValues f = estimate_subsurface_f(leaf.lanes(), rng.bits() % kLanes, wo, wi, absorption, rng);
          for (size_t lane = 0; lane < kLanes; ++lane) {
            together[lane].add(f[lane]);
            alone[lane].add(estimate_subsurface_f(leaf.tissue(lane), wo, wi, absorption, rng));
          }
        }
        for (size_t lane = 0; lane < kLanes; ++lane)
          EXPECT_LT(std::abs(test::z_score(together[lane], alone[lane])), limit)
              << specimen << " " << lane << ": " << together[lane].mean() << " " << alone[lane].mean();
      }
  }
}

TEST(SpectralWalk, OfOneWavelengthIsTheWalk) {
  const Dispersive leaf("soybean");
  for (int i = 0; i < 1000; ++i) {
    RandomStream a(static_cast<uint64_t>(i)), b(static_cast<uint64_t>(i));
    const FirstEvent first{a.uniform_double(), 0.3, 0.2};
    b.uniform_double();
    const WalkEnd one = walk(leaf.tissue(0), direction(50, 1), Absorption::weighted, first, a);
    const SpectralWalkEnd same = walk(leaf.lanes().first(1), 0, direction(50, 1), Absorption::weighted, first, b);
    EXPECT_EQ(one.fate, same.fate);
    EXPECT_EQ(one.wi, same.wi);
    EXPECT_EQ(one.weight, same.weight[0]);
  }
}

}  // namespace
}  // namespace frond::leaf
