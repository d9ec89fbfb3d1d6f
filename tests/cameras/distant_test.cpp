// The distant sensor: its target's cells, and what it refuses.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/input_error.h"
#include "tests/support/render_text.h"

namespace frond {
namespace {

using ::testing::HasSubstr;

/// A sensor above a lamp on the cell of smallest x and y of a target of 2 x 2 cells.
std::string seen_by(const std::string& parameters, int columns, int rows) {
  return fmt::format(
      "Film \"rgb\" \"integer xresolution\" {} \"integer yresolution\" {}\nPixelFilter \"box\"\n"
      "Camera \"distant\" \"float target\" [0 1 0 1 0] \"float distance\" 1 {}\nWorldBegin\n"
      "AreaLightSource \"diffuse\" \"bool twosided\" true\n"
      "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  0.5 0 0  0 0.5 0  0.5 0.5 0]",
      columns, rows, parameters);
}

TEST(DistantCamera, AdjacentRowsSeeACell) {
  const Film film = test::render_text(seen_by("\"float zenith\" [0 30] \"integer strata\" [2 2]", 2, 8));
  for (int view = 0; view < 2; ++view)
    for (int row = 0; row < 8; ++row) {
      EXPECT_EQ(film.mean(view, row)[1] > 0, row < 2) << row;
      EXPECT_FALSE(film.variance(view, row)[1] > 0) << row;  // each cell is lit or dark as a whole
    }
}

TEST(DistantCamera, WhatItCannotDivideIsRefused) {
  const auto error = [](const std::string& parameters, int columns = 1, int rows = 6) {
    return error_of([&] { test::render_text(seen_by("\"float zenith\" 0 " + parameters, columns, rows)); });
  };
  EXPECT_EQ(error("\"integer strata\" [3 2]"), "");
  EXPECT_THAT(error("\"integer strata\" [2 2]"),
              HasSubstr("test.pbrt:3:99: \"yresolution\", 6, is not a multiple of the 2 x 2 \"strata\""));
  EXPECT_THAT(error("\"integer strata\" 2"), HasSubstr("test.pbrt:3:98: \"strata\" takes 2 values, 1 given"));
  EXPECT_THAT(error("\"integer strata\" [1 2 3]"), HasSubstr("\"strata\" takes 2 values, 3 given"));
  EXPECT_THAT(error("\"integer strata\" [0 2]"), HasSubstr("\"strata\" is 0"));
  EXPECT_THAT(error("\"integer strata\" [1 1025]"), HasSubstr("\"strata\" is 1025"));
  EXPECT_THAT(error("", 2), HasSubstr("1 directions, a column of the film for each; \"xresolution\" is 2"));
}

}  // namespace
}  // namespace frond
