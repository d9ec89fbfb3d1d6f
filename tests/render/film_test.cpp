#include "render/film/film.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/math/random.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

FilmSettings settings(int width = 2, int height = 1) {
  return {.width = width,
          .height = height,
          .crop = {0, 0, width, height},
          .filename = "",
          .max_component = std::numeric_limits<double>::infinity()};
}

SensorResponse response(std::initializer_list<std::pair<uint16_t, double>> channels) {
  SensorResponse r;
  for (const auto& [channel, value] : channels) {
    r.channel[size_t(r.count)] = channel;
    r.value[size_t(r.count++)] = value;
  }
  return r;
}

TEST(Film, ColorsAreMeansOfAllSamples) {
  Film film({settings()});
  film.add(0, 0, std::array{1.0, 2.0, 3.0}, 1, true);
  film.add(0, 0, std::array{3.0, 2.0, 1.0}, 1, false);
  EXPECT_THAT(film.mean(0, 0), ::testing::ElementsAre(2, 2, 2));
  EXPECT_THAT(film.variance(0, 0), ::testing::ElementsAre(1, 0, 1));
  EXPECT_EQ(film.leaf_fraction(0, 0), 0.5);
  EXPECT_THAT(film.mean(1, 0), ::testing::ElementsAre(0, 0, 0));
}

TEST(Film, BandsAreMeansOfTheSamplesThatSawThem) {
  Film film({settings(), 3});
  film.add(1, 0, response({{0, 1}, {1, 10}}), 1, true);
  film.add(1, 0, response({{1, 20}, {2, 7}}), 1, true);
  film.add(1, 0, response({{0, 3}, {1, 30}}), 1, false);
  EXPECT_EQ(film.band_mean(1, 0, 0).mean, 2);
  EXPECT_EQ(film.band_mean(1, 0, 1).mean, 20);
  EXPECT_EQ(film.band_mean(1, 0, 2).mean, 7);
  EXPECT_EQ(film.band_mean(1, 0, 0).samples, 2);
  EXPECT_EQ(film.band_mean(1, 0, 0).variance, 1);  // 2 / 2
  EXPECT_NEAR(film.band_mean(1, 0, 1).variance, 100.0 / 3, 1e-12);
  EXPECT_EQ(film.band_mean(1, 0, 2).variance, 0);  // nobody can tell from one sample
  EXPECT_EQ(film.band_mean(0, 0, 1).samples, 0);
  EXPECT_EQ(film.band_mean(0, 0, 1).mean, 0);
  EXPECT_NEAR(film.foliar_ratio(), 2.0 / 3, 1e-15);
}

TEST(Film, FilterWeightsOfFewSamplesCannotVanish) {
  Film film({settings(), 2});
  for (const double weight : {1.5, -0.5, 1.5, 1.5}) {
    film.add(0, 0, response({{weight < 0 ? uint16_t{1} : uint16_t{0}, 2}}), weight, false);
  }
  // A band's samples are divided by their number times the mean weight of a sample, here 1.
  EXPECT_NEAR(film.band_mean(0, 0, 0).mean, 3, 1e-15);
  EXPECT_NEAR(film.band_mean(0, 0, 1).mean, -1, 1e-15);
}

TEST(Film, ExposureAndLimitHoldForBandsToo) {
  FilmSettings s = settings();
  s.exposure = 2;
  s.max_component = 10;
  Film film({s, 2});
  film.add(0, 0, response({{0, 3}, {1, 20}}), 1, false);
  EXPECT_EQ(film.band_mean(0, 0, 0).mean, 1.5);
  EXPECT_EQ(film.band_mean(0, 0, 1).mean, 10);
}

TEST(Film, WhatIsNoNumberIsBlackAndCounted) {
  for (const size_t bands : {0u, 3u}) {
    Film film({settings(), bands});
    film.add(0, 0, response({{0, 1}, {1, NAN}, {2, 1}}), 1, false);
    EXPECT_EQ(film.not_finite(), 1);
    EXPECT_EQ(bands == 0 ? film.mean(0, 0)[0] : film.band_mean(0, 0, 0).mean, 0);
  }
}

/// Sums are of whole numbers whatever a sample's size: the same one by one, in bundles and in any order.
TEST(Film, SamplesAddUpToTheSameBitsInAnyOrderAndGrouping) {
  std::vector<FilmTile::Sample> samples;
  RandomStream rng(1);
  for (int exponent = -50; exponent <= 32; ++exponent)
    for (const double factor : {1.0, -1.0, 1 - 0x1p-53, 1 + 0x1p-52}) {
      const double value = std::ldexp(factor, exponent), fraction = rng.uniform_double();
      samples.push_back({std::array{value, value * fraction, 0.0}, factor > 0 ? 1.25 : -0.25, false, {}});
    }
  samples.push_back({std::array{double(NAN), 1.0, 0.0}, 1, false, {}});
  const FilmFormat format{settings()};
  FilmTile one_by_one(format, format.settings.crop);
  for (const FilmTile::Sample& sample : samples) one_by_one.add(format, 0, 0, {&sample, 1});
  for (const size_t group : {3u, 16u, 64u, 100u, 1000u}) {
    std::shuffle(samples.begin(), samples.end(), std::mt19937(uint32_t(group)));
    FilmTile grouped(format, format.settings.crop);
    const std::span<const FilmTile::Sample> all(samples);
    for (size_t at = 0; at < all.size(); at += group)
      grouped.add(format, 0, 0, all.subspan(at, std::min(group, all.size() - at)));
    EXPECT_TRUE(grouped == one_by_one) << group;
  }
}

TEST(Film, BandsThatDoNotFitAreRefused) {
  EXPECT_THAT(error_of([] { Film({settings(65536, 65536), 10000}); }), ::testing::HasSubstr("of 10000 bands need"));
}

}  // namespace
}  // namespace frond
