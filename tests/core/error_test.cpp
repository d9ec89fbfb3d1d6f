#include "core/error.h"

#include <gtest/gtest.h>

namespace frond {
namespace {

Location at(int line, int column) { return {std::make_shared<const std::string>("leaf.pbrt"), line, column}; }

TEST(InputError, NamesFileLineAndColumn) {
  EXPECT_STREQ(InputError(at(3, 14), "no leaf").what(), "leaf.pbrt:3:14: no leaf");
}

TEST(InputError, WithoutAPlaceIsTheMessageAlone) { EXPECT_STREQ(InputError({}, "no leaf").what(), "no leaf"); }

TEST(Fail, FormatsItsArguments) {
  try {
    fail(at(1, 2), "{} is not {}", 3, "four");
    FAIL() << "fail returned";
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(), "leaf.pbrt:1:2: 3 is not four");
  }
}

TEST(Nearest, FindsAMisspeltWord) {
  EXPECT_EQ(nearest("rougness", {"reflectance", "roughness", "thickness"}), "roughness");
  EXPECT_EQ(nearest("Roughness", {"reflectance", "roughness"}), "roughness");
}

TEST(Nearest, FindsNothingAmongUnlikeWords) {
  EXPECT_EQ(nearest("zebra", {"reflectance", "roughness"}), "");
  EXPECT_EQ(nearest("x", {}), "");
  EXPECT_EQ(nearest("foo", {"box"}), "");
  EXPECT_EQ(nearest("abn", {"abm"}), "abm");
}

TEST(Suggestion, ProposesTheNearestWord) {
  EXPECT_EQ(suggestion("difuse", {"diffuse", "mix"}), "; did you mean \"diffuse\"?");
}

TEST(Suggestion, ListsWhatThereIsWhereNothingIsNear) {
  EXPECT_EQ(suggestion("zebra", {"diffuse", "mix"}), "; there are diffuse, mix");
  EXPECT_EQ(suggestion("zebra", {"diffuse"}), "; there is diffuse");
  EXPECT_EQ(suggestion("zebra", {}), "; there are none");
}

}  // namespace
}  // namespace frond
