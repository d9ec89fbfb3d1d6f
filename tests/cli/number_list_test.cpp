#include "cli/number_list.h"

#include <gmock/gmock.h>

#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(NumberList, TakesNumbersAndRanges) {
  EXPECT_THAT(parse_numbers("-x", "8"), ElementsAre(8));
  EXPECT_THAT(parse_numbers("-x", "0,8,30.5"), ElementsAre(0, 8, 30.5));
  EXPECT_THAT(parse_numbers("-x", "0:3:1"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(parse_numbers("-x", "3:0:-1.5"), ElementsAre(3, 1.5, 0));
  EXPECT_THAT(parse_numbers("-x", "0:10:4,85"), ElementsAre(0, 4, 8, 85));
  EXPECT_EQ(parse_numbers("-x", "0:1:0.1").size(), 11u);
  EXPECT_EQ(parse_numbers("-x", "0:180:1").size(), 181u);
}

TEST(NumberList, RefusesOtherThings) {
  for (const char* text : {"", "a", "1,,2", "1:2", "0:1:0", "0:1:-1", "nan", "inf", "1 2", "0:1e9:1e-3", "0x10"})
    EXPECT_THAT(error_of([text] { parse_numbers("--angles", text); }), HasSubstr("--angles")) << text;
}

TEST(Count, TakesWholeNumbersInAnyNotation) {
  EXPECT_EQ(parse_count("-x", "1e6", 1), 1'000'000);
  EXPECT_EQ(parse_count("-x", "12", 1), 12);
  EXPECT_EQ(parse_count("-x", "12", 1, 12), 12);
  EXPECT_THAT(error_of([] { parse_count("-x", "13", 1, 12); }), HasSubstr("-x takes a whole number from 1 to 12"));
  EXPECT_THAT(error_of([] { parse_count("-x", "0", 1); }), HasSubstr("-x takes a whole number from 1 on"));
  for (const char* text : {"0", "-1", "1.5", "1e30", "nan", "", "many"})
    EXPECT_THAT(error_of([text] { parse_count("--rays", text, 1); }), HasSubstr("--rays")) << text;
}

TEST(Number, IsTheWholeText) {
  EXPECT_EQ(finite_number("0.5"), 0.5);
  EXPECT_EQ(finite_number("+2"), 2);
  EXPECT_EQ(finite_number("-1e-6"), -1e-6);
  for (const char* other : {"", "+", "+-1", "0.01x", "x", "nan", "inf", "1e999", " 1"})
    EXPECT_FALSE(finite_number(other)) << other;
}

TEST(Product, TakesTwoWholeNumbers) {
  EXPECT_EQ(parse_product("-x", "20x40"), std::pair(20, 40));
  for (const char* text : {"", "20", "20x", "x40", "20x40x2", "2.5x4", "axb"})
    EXPECT_THAT(error_of([text] { parse_product("--patches", text); }), HasSubstr("--patches")) << text;
}

}  // namespace
}  // namespace frond
