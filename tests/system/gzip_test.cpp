#include "system/gzip.h"

#include <gtest/gtest.h>

namespace frond {
namespace {

/// A file that is made to fill the memory packs to a thousandth, text to a tenth or so.
TEST(Gzip, HowMuchItUnpacksFollowsFromItsSize) {
  EXPECT_EQ(most_unpacked(1000), size_t{1} << 25);
  EXPECT_EQ(most_unpacked(size_t{1} << 26), size_t{1} << 32);
}

}  // namespace
}  // namespace frond
