#include <gmock/gmock.h>

#include <map>

#include "instruments/errors/statistics.h"
#include "study/choose/pilot_pixels.h"
#include "study/choose/screening.h"

namespace frond::choose {
namespace {

using ::testing::ElementsAre;

/// Two open_choices of three options each, the last of which is the reference. The first open_choice's options are off
/// by `far`, the second's by `near` (of each: the cheapest, the middle one), in all pixels.
Screening screening(std::array<double, 2> far, std::array<double, 2> near, double cheap_noise = 1) {
  const std::vector<double> bias{far[0], far[1], near[0], near[1]};
  std::vector<std::vector<double>> products(4);
  for (size_t i = 0; i < 4; ++i)
    for (const double other : bias) products[i].push_back(bias[i] * other);
  ByOption<Screening::Single> singles(2);
  for (size_t q = 0; q < 2; ++q) singles[q] = {{0.7, cheap_noise, 2 * q}, {0.8, 1, 2 * q + 1}, {.is_reference = true}};
  const std::vector<ConvergencePoint> noise{{1, 0, {1, 0}}, {2, 0, {0.5, 0}}};
  return {std::move(singles), std::move(products), {noise, {}}};
}

TEST(Screening, BiasesAddUpAsImagesDo) {
  const Screening s = screening({0.03, 0.01}, {-0.04, 0.02});
  EXPECT_NEAR(s.bias({0, 0}), 0.01 * 0.01, 1e-15);
  EXPECT_NEAR(s.bias({1, 1}), 0.03 * 0.03, 1e-15);
  EXPECT_EQ(s.bias(s.reference()), 0);
}

TEST(Screening, TakesTheCheaperModelWhereItDoesLittleHarm) {
  const Screening s = screening({0.0005, 0.0002}, {0.03, 0.001});
  EXPECT_THAT(s.cheapest({0, 0}, 0.01), ElementsAre(0, 1));
  EXPECT_THAT(s.cheapest({0, 0}, 0.1), ElementsAre(0, 0));
  EXPECT_THAT(s.cheapest({0, 0}, 0.0001), ElementsAre(2, 2));
  EXPECT_THAT(s.cheapest({1, 2}, 0.1), ElementsAre(1, 2));
}

TEST(Screening, ABiasJustBelowTheRequestIsNotCheap) {
  // 0.7 / (1 - 0.9^2) is more than 1: so many more samples are needed for what is left.
  EXPECT_THAT(screening({0.009, 0.009}, {1, 1}).cheapest({0, 0}, 0.01), ElementsAre(2, 2));
}

TEST(Screening, TheBaseIsTheMeasureOfPriceAndNoise) {
  const Screening s = screening({0.03, 0.01}, {-0.04, 0.02}, 3);
  EXPECT_EQ(s.price(s.reference()), 1);
  EXPECT_EQ(s.noise(s.reference()), 1);
  EXPECT_EQ(s.noise({0, 2}), 3);
  EXPECT_NEAR(s.cost(s.reference(), 0.1), 100, 1e-9);  // noise falls as 1 / samples
}

TEST(Screening, NoiseIsPartOfThePrice) {
  EXPECT_THAT(screening({0, 0}, {1, 1}, 2).cheapest({0, 0}, 0.01), ElementsAre(1, 2));
}

TEST(Screening, TheWorstAnswerIsTheOneThatAddsMost) {
  const Screening s = screening({0.003, 0.001}, {0.004, 0.002});
  EXPECT_EQ(s.worst({0, 0}), 1u);
  EXPECT_EQ(s.worst({0, 1}), 0u);
  EXPECT_EQ(s.worst({2, 1}), 1u);
  EXPECT_EQ(s.worst({2, 2}), 2u);  // none is left
}

TEST(PilotPixels, AreAllWhereThereAreFew) {
  const auto pixels = pilot_pixels({3, 5, 7, 8}, 100, 1);
  EXPECT_EQ(pixels.size(), 12u);
  EXPECT_EQ(pixels.front().x, 3);
  EXPECT_EQ(pixels.back().y, 7);
}

TEST(PilotPixels, EveryPixelIsDrawnAlikeOften) {
  // 7 x 5 pixels, 3 x 2 cells: cells end within pixels.
  std::map<std::pair<int, int>, double> counts;
  constexpr int kRuns = 4000;
  size_t drawn = 0;
  for (uint64_t seed = 0; seed < kRuns; ++seed)
    for (const PixelPosition& p : pilot_pixels({10, 20, 17, 25}, 6, seed)) {
      ASSERT_TRUE(p.x >= 10 && p.x < 17 && p.y >= 20 && p.y < 25);
      counts[{p.x, p.y}] += 1;
      ++drawn;
    }
  ASSERT_EQ(counts.size(), 35u);
  std::vector<double> observed;
  for (const auto& [place, count] : counts) observed.push_back(count);
  const std::vector<double> expected(35, double(drawn) / 35);
  EXPECT_GT(chi_square_p(observed, expected), 1e-6);
}

}  // namespace
}  // namespace frond::choose
