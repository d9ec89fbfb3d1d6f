#include <gmock/gmock.h>

#include "jobs/record/arguments.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr JobParam kNumbers("angles", ArgumentKind::numbers, "", {.range = {0, 180}});
constexpr JobParam kCount("rays", ArgumentKind::count, "", {.range = {1, kCounts.max}});
constexpr JobParam kFew("few", ArgumentKind::count, "", {.range = {1, 12}});

std::string refusal(const JobParam& param, const std::string& word, Spelling spelling = command_spelling) {
  return error_of([&] { Arguments({&param}, spelling).set(param.name, word); });
}

TEST(NumberList, TakesNumbersAndRanges) {
  EXPECT_THAT(*parse_numbers("8"), ElementsAre(8));
  EXPECT_THAT(*parse_numbers("0,8,30.5"), ElementsAre(0, 8, 30.5));
  EXPECT_THAT(*parse_numbers("0:3:1"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(*parse_numbers("3:0:-1.5"), ElementsAre(3, 1.5, 0));
  EXPECT_THAT(*parse_numbers("0:10:4,85"), ElementsAre(0, 4, 8, 85));
  EXPECT_EQ(parse_numbers("0:1:0.1")->size(), 11u);
  EXPECT_EQ(parse_numbers("0:180:1")->size(), 181u);
}

TEST(NumberList, RefusesOtherThings) {
  for (const char* text :
       {"", "a", "1,,2", "1:2", "0:1:0", "0:1:-1", "nan", "inf", "1 2", "0:1e9:1e-3", "0x10", "1e999"})
    EXPECT_THAT(refusal(kNumbers, text), HasSubstr("--angles: a list of numbers from 0 to 180, as in 0,8,30")) << text;
  EXPECT_THAT(refusal(kNumbers, "0,181", python_spelling), HasSubstr("angles: a list of numbers"));
}

TEST(Count, TakesWholeNumbersInAnyNotation) {
  Arguments args({&kCount, &kFew}, command_spelling);
  args.set("rays", "1e6"), args.set("few", "12");
  EXPECT_EQ(args.count("rays"), 1'000'000);
  EXPECT_EQ(args.count("few"), 12);
  EXPECT_THAT(refusal(kFew, "13"), HasSubstr("--few: a whole number from 1 to 12 is needed; \"13\" was given"));
  for (const char* text : {"0", "-1", "1.5", "1e30", "nan", "", "many"})
    EXPECT_THAT(refusal(kCount, text), HasSubstr("--rays")) << text;
}

}  // namespace
}  // namespace frond
