#include "image/terminal_image.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace frond {
namespace {

Image gray_image(int width, int height) {
  Image image(width, height, {"R", "G", "B"});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (size_t c = 0; c < 3; ++c) image.at(x, y, c) = float(x + 10 * y);
  return image;
}

TEST(TerminalImages, FitIntoColumnsAndRowsAndAreNeverEnlarged) {
  const auto size_of = [](int width, int height, int columns, int rows) {
    const Image fitted = fitted_image(gray_image(width, height), columns, rows);
    return std::pair{fitted.width, fitted.height};
  };
  EXPECT_EQ(size_of(512, 256, 80, 24), std::pair(80, 40));
  EXPECT_EQ(size_of(512, 512, 80, 24), std::pair(48, 48));
  EXPECT_EQ(size_of(24, 16, 80, 24), std::pair(24, 16));
  EXPECT_EQ(size_of(1000, 1, 80, 24), std::pair(80, 1));
  EXPECT_EQ(size_of(1, 1000, 80, 24), std::pair(1, 48));
  for (int columns = 1; columns < 40; ++columns) EXPECT_EQ(size_of(49, 49, columns, 100).first, columns);
}

TEST(TerminalImages, AreMeansOfWhatTheyStandFor) {
  const Image fitted = fitted_image(gray_image(4, 4), 2, 10);
  EXPECT_EQ(fitted.at(0, 0, 0), 5.5f);
  EXPECT_EQ(fitted.at(1, 0, 2), 7.5f);
  EXPECT_EQ(fitted.at(0, 1, 1), 25.5f);
  // Of a width that does not divide, every pixel counts once.
  const Image uneven = fitted_image(gray_image(5, 1), 2, 10);
  EXPECT_EQ(2 * uneven.at(0, 0, 0) + 3 * uneven.at(1, 0, 0), 0 + 1 + 2 + 3 + 4);
}

TEST(TerminalImages, HaveAHalfBlockForTwoPixels) {
  Image image(2, 3, {"R", "G", "B"});
  image.pixels = {1,    0,    0,    0, 1,    0,   //
                  0,    0,    1,    2, 0.5f, -1,  //
                  0.2f, 0.4f, 0.6f, 0, 0,    0};
  EXPECT_EQ(terminal_text(image),
            "\x1b[38;2;255;0;0m\x1b[48;2;0;0;255m▀"
            "\x1b[38;2;0;255;0m\x1b[48;2;255;128;0m▀\x1b[0m\n"
            "\x1b[38;2;51;102;153m▀\x1b[38;2;0;0;0m▀\x1b[0m\n");  // below is nothing
}

}  // namespace
}  // namespace frond
