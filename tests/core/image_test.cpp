#include "core/image.h"

#include <gmock/gmock.h>

#include <array>

namespace frond {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Two pixels of three channels.
Image two_pixels() {
  Image image(1, 2, {"R", "G", "leaf"});
  image.pixels = {1, 2, 3, 4, 5, 6};
  return image;
}

TEST(Image, IsBlackAtFirst) {
  EXPECT_THAT(Image(3, 2, {"R", "G"}).pixels, ::testing::AllOf(::testing::SizeIs(12), Each(0)));
}

TEST(Image, KnowsChannelsByName) {
  EXPECT_EQ(two_pixels().channel("leaf"), 2u);
  EXPECT_EQ(two_pixels().channel("B"), std::nullopt);
  EXPECT_EQ(two_pixels().at(0, 1, 1), 5);
}

TEST(Image, AChannelIsAPlane) {
  EXPECT_THAT(two_pixels().plane(0), ElementsAre(1, 4));
  EXPECT_THAT(two_pixels().plane(2), ElementsAre(3, 6));
  EXPECT_THAT(Image().plane(0), IsEmpty());
}

TEST(Image, ChannelsAreSelectedInAnyOrderAndAgain) {
  const Image chosen = two_pixels().selected(std::array<size_t, 3>{2, 0, 0}, {"R", "G", "B"});
  EXPECT_THAT(chosen.channels, ElementsAre("R", "G", "B"));
  EXPECT_THAT(chosen.pixels, ElementsAre(3, 1, 1, 6, 4, 4));
  EXPECT_EQ(chosen.height, 2);
}

}  // namespace
}  // namespace frond
