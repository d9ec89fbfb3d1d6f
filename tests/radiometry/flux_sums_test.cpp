// Sums of organs.

#include "radiometry/flux_sums.h"

#include <gmock/gmock.h>

#include "tests/support/input_error.h"

namespace frond {
namespace {

TEST(OrganSums, AreRefusedBeyondTheirRange) {
  constexpr double kTerm = 0x1p20;
  OrganSums sums(2, 1), others(2, 1);
  for (int i = 0; i < 40; ++i) {
    sums.add(1, 0, {kTerm, 1});
    others.add(1, 0, {kTerm, 1});
  }
  EXPECT_EQ(sums.at(0).sum, 40 * kTerm);
  others.add(sums.bytes());
  EXPECT_THAT(error_of([&] { (void)others.at(1); }), ::testing::HasSubstr("take fewer paths"));
  for (int i = 0; i < 40; ++i) sums.add(1, 0, {kTerm, 1});
  EXPECT_THAT(error_of([&] { (void)sums.bytes(); }), ::testing::HasSubstr("take fewer paths"));
}

}  // namespace
}  // namespace frond
