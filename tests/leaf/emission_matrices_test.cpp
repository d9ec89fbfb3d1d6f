#include "leaf/fluorescence/emission_matrices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/input_error.h"

namespace frond::leaf {
namespace {

using ::testing::HasSubstr;

const std::string kColumns = "excitation_nm,emission_nm,Mb,Mf\n";
const std::string kRows = "450,700,1e-4,2e-4\n450,740,3e-4,4e-4\n650,700,5e-4,0\n650,740,7e-4,8e-4\n";

EmissionMatrices parse(const std::string& text, const MatrixUnit& unit = {}) { return {text, "m.csv", unit}; }
std::string refusal(const std::string& text) {
  return error_of([&] { parse(text); });
}

TEST(EmissionMatrices, AreBilinearAndEndWithTheFile) {
  const EmissionMatrices m = parse("# a leaf\n" + kColumns + kRows);
  EXPECT_EQ(m.name(), "m.csv");
  for (const bool abaxial : {false, true}) {
    EXPECT_DOUBLE_EQ(m.at(700, 450, abaxial).lit, 1e-4);
    EXPECT_DOUBLE_EQ(m.at(740, 650, abaxial).opposite, 8e-4);
    EXPECT_DOUBLE_EQ(m.at(710, 500, abaxial).lit,
                     0.75 * (0.75 * 1e-4 + 0.25 * 3e-4) + 0.25 * (0.75 * 5e-4 + 0.25 * 7e-4));
    for (const auto& [emission, excitation] : {std::pair{699.9, 500.0}, {740.1, 500.0}, {720.0, 449.9}, {720.0, 650.1}})
      EXPECT_EQ(m.at(emission, excitation, abaxial).lit + m.at(emission, excitation, abaxial).opposite, 0);
  }
  EXPECT_DOUBLE_EQ(m.emitted(450), 40 * (3e-4 + 7e-4) / 2);
  EXPECT_DOUBLE_EQ(m.emitted(550), 40 * (3e-4 + 7e-4 + 5e-4 + 15e-4) / 4);
  EXPECT_EQ(m.emitted(400), 0);
}

TEST(EmissionMatrices, OfTheAbaxialSideFollowTheAngle) {
  const EmissionMatrices m = parse(
      "theta_deg,excitation_nm,emission_nm,Mb,Mb_se,Mf,material\n"
      "172,400,640,1e-4,0,2e-4,a\n172,400,700,1e-4,0,2e-4,a\n172,500,640,1e-4,0,2e-4,a\n172,500,700,1e-4,0,2e-4,a\n"
      "8,450,700,3e-4,0,2e-4,a\n8,450,740,3e-4,0,2e-4,a\n8,650,700,3e-4,0,2e-4,a\n8,650,740,3e-4,0,2e-4,a\n");
  EXPECT_DOUBLE_EQ(m.at(700, 450, false).lit, 3e-4);
  EXPECT_EQ(m.at(640, 450, false).lit, 0);
  EXPECT_DOUBLE_EQ(m.at(640, 450, true).lit, 1e-4);
  EXPECT_DOUBLE_EQ(m.emitted(475), (40 * 5e-4 + 60 * 3e-4) / 2);
}

TEST(EmissionMatrices, TakesRowsInAnyOrder) {
  const EmissionMatrices m =
      parse(kColumns + "650,740,7e-4,8e-4\n450,740,3e-4,4e-4\n650,700,5e-4,0\n450,700,1e-4,2e-4\n");
  EXPECT_DOUBLE_EQ(m.at(700, 450, false).lit, 1e-4);
  EXPECT_DOUBLE_EQ(m.at(740, 450, false).lit, 3e-4);
}

TEST(EmissionMatrices, ConvertsUnits) {
  EXPECT_DOUBLE_EQ(parse(kColumns + kRows, {.scale = 0.2}).at(740, 450, false).opposite, 0.8e-4);
  // A photon of 740 nm has 450 / 740 of the energy of one of 450 nm.
  EXPECT_DOUBLE_EQ(parse(kColumns + kRows, {.is_energy = true}).at(740, 450, false).opposite, 4e-4 * 740 / 450);
}

TEST(EmissionMatrices, RefusesBadFilesByLineAndColumn) {
  struct {
    std::string text, message;
  } const kCases[] = {
      {"", "m.csv:1:1: there is no column \"excitation_nm\""},
      {"excitation_nm,emission_nm,Mb\n", "m.csv:1:1: there is no column \"Mf\": matrices of fluorescence have"},
      {"excitation_nm,emission_nm,Mb,Mf,mb\n", "m.csv:1:33: there are two columns \"Mb\""},
      {kColumns, "m.csv:1:1: there is no row for light on the adaxial side"},
      {kColumns + "450,700,1e-4\n", "m.csv:2:1: 3 fields, but the file has 4 columns"},
      {kColumns + "450,700,1e-4,-1e-9\n", "m.csv:2:14: Mf is a number of photons per nm, at least 0; -1e-09 was given"},
      {kColumns + "450,700,nan,0\n", "m.csv:2:9: Mb is a number of photons per nm, at least 0; nan was given"},
      {kColumns + "450,700,0,inf\n", "m.csv:2:11: Mf is"},
      {kColumns + "450,700,x,0\n", "m.csv:2:9: Mb is a number, \"x\" was given"},
      {kColumns + "350,700,0,0\n", "m.csv:2:1: excitation_nm is from 400 to 750, 350 was given"},
      {kColumns + "450,900,0,0\n", "m.csv:2:5: emission_nm is from 640 to 850, 900 was given"},
      {kColumns + kRows + "450,740,3e-4,4e-4\n", "m.csv:6:1: 450 to 740 nm is there twice, first in line 3"},
      {kColumns + "450,700,0,0\n450,740,0,0\n", "m.csv:2:1: matrices have at least two wavelengths of excitation"},
      // A hole, and a file that is cut short.
      {kColumns + "450,700,0,0\n650,700,0,0\n650,740,0,0\n",
       "m.csv:3:1: there is no row for 450 to 740 nm: every wavelength of excitation needs the same wavelengths of "
       "emission, and 740 nm is in line 4"},
      {kColumns + "450,700,0,0\n450,740,0,0\n650,700,0,0\n", "m.csv:4:1: there is no row for 650 to 740 nm"},
      {kColumns + "450,700,0,0\n450,740,0,0\n650,700,.04,0\n650,740,.04,0\n",
       "m.csv:4:1: 1.6 photons leave the leaf for each photon of 650 nm, at most 1 can"},
      {"theta_deg,excitation_nm,emission_nm,Mb,Mf\n0,450,700,0,0\n8,450,740,0,0\n", "m.csv:3:1: theta_deg 8 after 0"},
      {"theta_deg,excitation_nm,emission_nm,Mb,Mf\n120,450,700,0,0\n", "m.csv:1:1: there is no row for light on the"},
  };
  for (const auto& [text, message] : kCases) EXPECT_THAT(refusal(text), HasSubstr(message));
}

TEST(EmissionMatrices, NamesAFileThatCannotBeRead) {
  const Location where{std::make_shared<const std::string>("scene.pbrt"), 3, 5};
  EXPECT_THAT(error_of([&] { read_emission_matrices("/nowhere/m.csv", {}, where); }), HasSubstr("scene.pbrt:3:5: "));
}

}  // namespace
}  // namespace frond::leaf
