#include "leaf/tissue/specimen_file.h"

#include <gmock/gmock.h>

#include "leaf/tissue/specimens.h"
#include "tests/support/input_error.h"

namespace frond::leaf {
namespace {

using testing::HasSubstr;

TEST(SpecimenFile, HasNumbersOfLeavesByTheirNames) {
  const std::string text =
      "# made for this test\nleaf,specimen,structure,sieve,absorption,thickness,anthocyanins,thickness_se,status\n"
      "A,tomato,,,,3e-4,,0.1,fitted\nB,,unifacial,true,prospect,,2,,fitted\n";
  TissueParams a = find_specimen("tomato")->params, b = find_specimen("maize")->params;
  a.thickness_m = 3e-4;
  b.sieve_and_detour = true, b.absorption_tables = AbsorptionTables::prospect, b.number("anthocyanins") = 2;
  for (const char* only_published : {"protein", "cellulose", "lignin"}) b.number(only_published) = 0;
  EXPECT_EQ(parse_specimen(text, "leaves.csv", "A"), a);
  EXPECT_EQ(parse_specimen(text, "leaves.csv", "B"), b);
  EXPECT_EQ(parse_specimen("leaf;thickness\nC;0,0003\n", "leaves.csv", "").thickness_m, 3e-4);
}

TEST(SpecimenFile, WhatIsNoLeafIsRefused) {
  const auto error = [](const std::string& rows, const std::string& name = "A") {
    return error_of([&] { parse_specimen("leaf,specimen,sieve,thickness,status\n" + rows, "leaves.csv", name); });
  };
  EXPECT_THAT(error("A,soyabean,,,fitted\n"), HasSubstr("leaves.csv:2:3: there is no specimen \"soyabean\""));
  EXPECT_THAT(error("A,,maybe,,fitted\n"), HasSubstr("leaves.csv:2:4: sieve is true or false, not \"maybe\""));
  EXPECT_THAT(error("A,,,1,fitted\n"), HasSubstr("leaves.csv:2:5: thickness is a number from 1e-06 to 0.01 m"));
  EXPECT_THAT(error("A,,,,R is too large\n"), HasSubstr("leaves.csv:2:6: this leaf was not fitted"));
  EXPECT_THAT(error("A,,,,fitted\nA,,,,fitted\n"), HasSubstr("leaves.csv:3:1: the leaf \"A\" occurs twice"));
  EXPECT_THAT(error("A,,,,fitted\n", "B"), HasSubstr("there is no leaf \"B\""));
  EXPECT_THAT(error("A,,,,fitted\nB,,,,fitted\n", ""),
              HasSubstr("2 leaves: FILE:LEAF selects one, as in leaves.csv:A"));
  EXPECT_THAT(error("A,,,\n"), HasSubstr("4 fields, but the file has 5 columns"));
  EXPECT_THAT(error_of([] { parse_specimen("name,thickness\n", "leaves.csv", ""); }), HasSubstr("a column \"leaf\""));
  EXPECT_THAT(error_of([] { parse_specimen("leaf,thicknes\nA,3e-4\n", "leaves.csv", ""); }),
              HasSubstr("leaves.csv:1:6: there is no parameter \"thicknes\"; did you mean \"thickness\"?"));
}

}  // namespace
}  // namespace frond::leaf
