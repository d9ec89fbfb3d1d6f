#include <gtest/gtest.h>

#include "tests/cli/table.h"

namespace frond {
namespace {

/// Measured figures that reports show for comparison: an error in the file would be an error in the report.
TEST(Reference, MeasuredSoybeanLeavesAreWholeAndPossible) {
  const CsvTable csv = parse_csv(bytes_of(FROND_SOURCE_DIR "/tests/reference/lopex93_soybean.csv"));
  ASSERT_EQ(csv.rows.size(), 211u);
  for (size_t i = 0; i < csv.rows.size(); ++i) {
    EXPECT_EQ(csv.number(i, "wavelength_nm"), 400 + 10 * double(i));
    for (const std::string name : {"R", "T"}) {
      EXPECT_GE(csv.number(i, name + "_min"), 0);
      EXPECT_LE(csv.number(i, name + "_min"), csv.number(i, name + "_mean"));
      EXPECT_LE(csv.number(i, name + "_mean"), csv.number(i, name + "_max"));
    }
    EXPECT_LE(csv.number(i, "R_mean") + csv.number(i, "T_mean"), 1);
  }
}

}  // namespace
}  // namespace frond
