#include "leaf/fit/measured_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "leaf/table/table_file.h"
#include "tests/support/input_error.h"

namespace frond::leaf {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

MeasuredTable parse(const std::string& text, double surface = 0) {
  return measured_table(parse_measured_spectra(text, "leaf.csv", {}), surface, "leaf.csv");
}
std::string refusal(const std::string& text) {
  return error_of([&] { parse(text); });
}

TEST(MeasuredTable, HoldsValuesAsTheyAre) {
  const MeasuredTable made = parse(
      "theta_deg,nm,R,T,side\n8,500,.05,.1,upper\n60,500,.2,.08,upper\n"
      "8,500,.06,.11,lower\n60,500,.21,.09,lower\n",
      0.055);
  EXPECT_EQ(made.warning, "");
  EXPECT_THAT(made.table.theta_deg, ElementsAre(8, 60, 120, 172));
  EXPECT_THAT(made.table.wavelengths_nm, ElementsAre(500));
  EXPECT_EQ(
      made.table.shares,
      (std::vector<Shares>{{.05, 0, .1}, {.055, .2 - .055, .08}, {.055, .21 - .055, .09}, {.055, .06 - .055, .11}}));
}

TEST(MeasuredTable, SaysWhatItLeavesOutOrChanges) {
  const MeasuredTable made = parse("nm,R,T\n500,-0.001,.1\n510,.1,\n520,.52,.5\n530,.1,.1\n");
  EXPECT_THAT(made.table.wavelengths_nm, ElementsAre(500, 520, 530));
  EXPECT_EQ(made.table.at(0, 0), (Shares{0, 0, .1}));
  EXPECT_DOUBLE_EQ(made.table.at(1, 0).subsurface + made.table.at(1, 0).transmitted, 1);
  EXPECT_EQ(made.warning,
            "leaf.csv: wavelengths without R and T at every angle, left out: 1; values below 0, taken as 0: 1; pairs "
            "with R + T above 1, divided by their sum: 1");
}

TEST(MeasuredTable, RefusesWhatIsNoLeaf) {
  EXPECT_THAT(refusal("nm,R\n500,.1\n"),
              HasSubstr("leaf.csv: no wavelength has both R and T: a leaf material needs both"));
  EXPECT_THAT(refusal("nm,R,T\n500,.1,.1\n500,.1,.1\n"), HasSubstr("500 nm at 8 degrees occurs twice"));
  EXPECT_THAT(refusal("nm,R,T,side\n500,.1,.1,lower\n"), HasSubstr("all measurements are of the abaxial side"));
}

TEST(MeasuredTable, TellsLeafTablesFromSpectra) {
  EXPECT_TRUE(is_leaf_table("# a comment\n\ntheta_deg, wavelength_nm, Rs ,Rd,T\n"));
  EXPECT_TRUE(is_leaf_table("Rd,T\r\n"));
  EXPECT_FALSE(is_leaf_table("wavelength,R,T\n500,.1,.1\n"));
  EXPECT_FALSE(is_leaf_table("500 .1 .1\n# Rs,Rd\n"));
  EXPECT_TRUE(is_leaf_table("# neither\n"));
}

}  // namespace
}  // namespace frond::leaf
