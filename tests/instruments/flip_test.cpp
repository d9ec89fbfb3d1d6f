#include "instruments/errors/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace frond {
namespace {

constexpr int kWidth = 40, kHeight = 24;

Image uniform(std::array<float, 3> rgb) {
  Image image(kWidth, kHeight, {"R", "G", "B"});
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = rgb[i % 3];
  return image;
}

/// Loud texture of 17 levels.
Image pattern(int seed) {
  Image image(kWidth, kHeight, {"R", "G", "B"});
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y, size_t(c)) = float((x * 7 + y * 13 + c * 5 + seed * (x * y + 3 * c)) % 17) / 16;
  return image;
}

TEST(Flip, OfAnImageAndItselfIsNothing) {
  for (const float v : flip_map(pattern(0), pattern(0))) EXPECT_EQ(v, 0);
}

TEST(Flip, IsTheSameBothWays) {
  const auto forth = flip_map(pattern(0), pattern(3)), back = flip_map(pattern(3), pattern(0));
  EXPECT_EQ(forth, back);
}

/// The colour difference is scaled to be 1 between green and blue. Between black and white it is 100^0.7 = 25.1 of the
/// 41.3 between those two, of which the first 40 % take up 95 % of the range.
TEST(Flip, OfUniformImagesFollowsFromTheFormula) {
  EXPECT_NEAR(mean_flip(uniform({0, 1, 0}), uniform({0, 0, 1})), 1, 1e-5);
  EXPECT_NEAR(mean_flip(uniform({0, 0, 0}), uniform({1, 1, 1})), 0.9674, 5e-5);
}

TEST(Flip, StaysWithinItsRange) {
  for (const auto& [a, b] : {std::pair{pattern(0), pattern(3)}, {uniform({0, 0, 0}), pattern(1)}}) {
    const auto map = flip_map(a, b);
    EXPECT_GE(*std::ranges::min_element(map), 0);
    EXPECT_LE(*std::ranges::max_element(map), 1);
  }
}

TEST(Flip, ShowsWhatADisplayShows) {
  EXPECT_EQ(mean_flip(uniform({1, 1, 1}), uniform({7, 1.5f, 1})), 0);
  EXPECT_EQ(mean_flip(uniform({0, 0, 0}), uniform({-1, 0, 0})), 0);
}

/// Results of the authors' own program (flip-evaluator 1.7 of the Python package index) for the same pixels. It
/// computes in single precision with rounded constants.
TEST(Flip, AgreesWithTheAuthorsProgram) {
  constexpr double kClose = 1e-3;
  struct Expected {
    double ppd, mean, first, middle, last;
  };
  for (const Expected& e :
       {Expected{67, 0.351057, 0.674596, 0.364061, 0.462732}, {20, 0.831187, 0.962112, 0.785099, 0.779450}}) {
    const auto map = flip_map(pattern(0), pattern(3), e.ppd);
    EXPECT_NEAR(mean_flip(pattern(0), pattern(3), e.ppd), e.mean, kClose) << e.ppd;
    EXPECT_NEAR(map.front(), e.first, kClose) << e.ppd;
    EXPECT_NEAR(map[12 * kWidth + 20], e.middle, kClose) << e.ppd;
    EXPECT_NEAR(map.back(), e.last, kClose) << e.ppd;
  }
  EXPECT_NEAR(mean_flip(uniform({0.2f, 0.2f, 0.2f}), uniform({0.25f, 0.2f, 0.2f})), 0.153733, kClose);
}

}  // namespace
}  // namespace frond
