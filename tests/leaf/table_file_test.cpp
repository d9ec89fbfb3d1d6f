#include "leaf/table/table_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "leaf/table/lookup.h"
#include "leaf/tissue/specimens.h"
#include "tests/support/input_error.h"

namespace frond::leaf {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kColumns = "theta_deg,wavelength_nm,Rs,Rd,T\n";

Table parse(const std::string& text) { return parse_table(text, "leaf.csv"); }
std::string refusal(const std::string& text) {
  return error_of([&] { parse(text); });
}

TEST(TableFile, ReadsBackToTheBit) {
  for (const TableMethod method : {TableMethod::solve, TableMethod::monte_carlo}) {
    const TableRequest request{.params = find_specimen("maize")->params,
                               .wavelengths_nm = {608, 455},
                               .theta_deg = {0, 10.5, 90, 91, 180},
                               .method = method,
                               .rays = 30};
    const Table made = make_table(request, ThreadPool(1)), read = parse(to_csv(made, "# by hand\n"));
    EXPECT_EQ(read.theta_deg, made.theta_deg);
    EXPECT_EQ(read.wavelengths_nm, made.wavelengths_nm);
    EXPECT_EQ(read.shares, made.shares);
    EXPECT_EQ(read.standard_errors, made.standard_errors);
    EXPECT_EQ(read.error, made.error);
    EXPECT_EQ(made.standard_errors.empty(), method == TableMethod::solve);
  }
}

TEST(TableFile, ReadsWhatPeopleWrite) {
  const Table table = parse(
      "\xef\xbb\xbf# a measured leaf\r\n"
      "\n"
      "wavelength_nm, theta_deg, T, Rd, Rs, A\r\n"
      "  # by angle, then by wavelength\n"
      "550, 0, .2, .1, .04, .66\r\n"
      "450, 0, .02, .05, .04, .89\n"
      "550, 60, .15, .1, .1, .65\n"
      "450, 60, 1e-2, .05, .1, .84");
  EXPECT_THAT(table.theta_deg, ElementsAre(0, 60));
  EXPECT_THAT(table.wavelengths_nm, ElementsAre(550, 450));
  EXPECT_EQ(table.at(0, 1), (Shares{.1, .1, .15}));
  EXPECT_EQ(table.at(1, 0), (Shares{.04, .05, .02}));
  EXPECT_TRUE(table.standard_errors.empty());
  EXPECT_TRUE(table.has_equal_sides());
}

TEST(TableFile, ReadsTheLayoutsOfSpreadsheets) {
  for (const std::string text :
       {"theta_deg;wavelength_nm;Rs;Rd;T\r\n8;550;0,04;0,06;0,12\r\n",
        "THETA_DEG,WAVELENGTH_NM,RS,RD,T\n8,550,.04,.06,.12\n", "theta_deg wavelength_nm Rs Rd T\n8 550 .04 .06 .12\n",
        "\"\",\"theta_deg\",\"wavelength_nm\",\"Rs\",\"Rd\",\"T\"\n\"1\",8,550,.04,.06,.12\n"}) {
    EXPECT_TRUE(is_leaf_table(text)) << text;
    EXPECT_EQ(parse(text).at(0, 0), (Shares{.04, .06, .12})) << text;
  }
}

TEST(TableFile, RefusesBadRowsByLine) {
  const std::string two_rows = kColumns + "0,550,.1,.2,.3\n";
  struct {
    std::string row, message;
  } const kCases[] = {
      {"10,550,.4,.4,.4\n", "leaf.csv:3:1: Rs + Rd + T is 1.2: a leaf scatters 1 at most"},
      {"10,550,.1,nan,.4\n", "leaf.csv:3:11: Rd is a share of the light, from 0 to 1; nan was given"},
      {"10,550,-.1,.1,.4\n", "leaf.csv:3:8: Rs is a share of the light, from 0 to 1; -0.1 was given"},
      {"10,550,.1,.1,inf\n", "leaf.csv:3:14: T is a share"},
      {"10,550,.1,,.4\n", "leaf.csv:3:11: Rd is a number, \"\" was given"},
      {"10,550,.1,12%,.4\n", "leaf.csv:3:11: Rd is a number, \"12%\" was given"},
      {"10,550,.1,.4\n", "leaf.csv:3:1: 4 fields, but the file has 5 columns"},
      {"10,550,.1,.4,.1,.1\n", "leaf.csv:3:1: 6 fields, but the file has 5 columns"},
      {"190,550,.1,.1,.1\n", "leaf.csv:3:1: theta_deg is from 0 to 180, 190 was given"},
      {"10,0,.1,.1,.1\n", "leaf.csv:3:4: wavelength_nm is above 0, 0 was given"},
      {"0,550,.1,.1,.1\n", "leaf.csv:3:1: theta_deg 0 comes after 0 at 550 nm (line 2): angles ascend, each once"},
      {"20,550,.1,.1,.1\n10,550,.1,.1,.1\n", "leaf.csv:4:1: theta_deg 10 comes after 20 at 550 nm (line 3)"},
      {"20,550,.1,.1,.1\n0,450,.1,.1,.1\n",
       "leaf.csv:4:1: 450 nm has no row for theta_deg 20, which 550 nm has (line 3)"},
      {"0,450,.1,.1,.1\n20,450,.1,.1,.1\n",
       "leaf.csv:2:1: 550 nm has no row for theta_deg 20, which 450 nm has (line 4)"},
      {"5,450,.1,.1,.1\n", "leaf.csv:3:1: 450 nm has no row for theta_deg 0, which 550 nm has (line 2)"},
  };
  for (const auto& [row, message] : kCases) EXPECT_THAT(refusal(two_rows + row), StartsWith(message));
}

TEST(TableFile, RefusesBadColumns) {
  EXPECT_THAT(refusal(""), HasSubstr("the table is empty: a line with the names of the columns and then a row"));
  EXPECT_THAT(refusal("# nothing\n\n" + kColumns),
              StartsWith("leaf.csv:3:1: the table is empty: a row for each angle"));
  EXPECT_THAT(refusal(std::string("\x7f"
                                  "ELF\0",
                                  5)),
              HasSubstr("not a text file"));
  EXPECT_THAT(refusal("theta,wavelength_nm,Rs,Rd,T\n"), HasSubstr("no column \"theta\" in a leaf's table"));
  EXPECT_THAT(refusal("theta_deg,wavelength,Rs,Rd,T\n"), HasSubstr("did you mean \"wavelength_nm\"?"));
  EXPECT_THAT(refusal("theta_deg,wavelength_nm,Rs,Rd\n"), HasSubstr("there is no column \"T\"; a leaf's table has"));
  EXPECT_THAT(refusal("theta_deg,wavelength_nm,Rs,Rd,T,T\n"), HasSubstr("leaf.csv:1:33: there are two columns \"T\""));
  EXPECT_THAT(refusal("theta_deg,wavelength_nm,Rs,Rd,T,Rs_se\n"), HasSubstr("come together or not at all"));
  EXPECT_THAT(refusal("0,550,.1,.1,.1\n"), HasSubstr("the first line has no names of columns"));
  EXPECT_THAT(refusal(kColumns + "100,550,.1,.1,.1\n"), HasSubstr("those of the adaxial side are missing"));
  EXPECT_THAT(error_of([] { read_table("/no/such.csv", {}); }), HasSubstr("No such file"));
  EXPECT_THAT(error_of([] { read_table("/tmp", {}); }), HasSubstr("cannot read leaf table \"/tmp\""));
  EXPECT_EQ(error_of([] { read_table("/dev/zero", {}); }),
            "cannot read leaf table \"/dev/zero\": it is no regular file");
}

TEST(Table, MeanOfSidesIsTheirMean) {
  Table table{.theta_deg = {0, 90, 180}, .wavelengths_nm = {500}};
  table.shares = {{.1, .2, .3}, {1, 0, 0}, {.1, .4, .1}};
  table.standard_errors = {{.3, .3, .3}, {}, {.4, .4, .4}};
  const Table mean = mean_of_sides(table);
  EXPECT_THAT(mean.theta_deg, ElementsAre(0, 90));
  EXPECT_NEAR(mean.at(0, 0).subsurface, .3, 1e-15);
  EXPECT_NEAR(mean.at(0, 0).transmitted, .2, 1e-15);
  EXPECT_EQ(mean.at(0, 1), (Shares{1, 0, 0}));
  EXPECT_NEAR(mean.standard_errors[0].surface, .25, 1e-15);
}

TEST(Table, IsLinearBetweenItsWavelengths) {
  Table table{.theta_deg = {0}, .wavelengths_nm = {600, 500}};
  table.shares = {{.3, 0, 0}, {.1, 0, 0}};
  const Table at = at_wavelengths(table, {525, 600, 500, 700});
  EXPECT_NEAR(at.at(0, 0).surface, .15, 1e-15);
  EXPECT_EQ(at.at(1, 0).surface, .3);
  EXPECT_EQ(at.at(2, 0).surface, .1);
  EXPECT_EQ(at.at(3, 0).surface, .3);
}

TEST(TableLookup, HoldsTheNearestAngleOfEachSide) {
  const Table table = parse(kColumns + "8,550,.04,.1,.2\n172,550,.04,.3,.1\n");
  const TableLookup lookup = TableLookup::for_lanes(table);
  for (const float cosine : {1e-3f, 0.3f, 0.99f, 1.f}) {
    EXPECT_FLOAT_EQ(lookup(cosine, {}).subsurface[0], .1f);
    EXPECT_FLOAT_EQ(lookup(-cosine, {}).subsurface[0], .3f);
  }
  const TableLookup equal = TableLookup::for_lanes(parse(kColumns + "30,550,.04,.1,.2\n"));
  EXPECT_FLOAT_EQ(equal(0.5f, {}).transmitted[0], .2f);
  EXPECT_FLOAT_EQ(equal(-0.5f, {}).transmitted[0], .2f);
}

TEST(TableLookup, FindsItsPlaceAmongUnevenWavelengths) {
  Table table{.theta_deg = {0}, .wavelengths_nm = {400, 401, 420, 700, 700.5}};
  for (const double nm : table.wavelengths_nm) table.shares.push_back({(nm - 400) / 1000, 0, 0});
  const TableLookup lookup = TableLookup::for_spectra(table);
  SampledWavelengths lambda;
  lambda.count = 1;
  for (float nm = 400; nm <= 700.5f; nm += 0.25f) {
    lambda.nm[0] = nm;
    EXPECT_NEAR(lookup(1, lookup.select(lambda)).surface[0], (nm - 400) / 1000, 1e-6) << nm;
  }
}

}  // namespace
}  // namespace frond::leaf
