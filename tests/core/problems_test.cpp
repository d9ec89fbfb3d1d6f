#include "core/messages/problems.h"

#include <gmock/gmock.h>

namespace frond {
namespace {

using ::testing::ElementsAre;

TEST(Problems, CountAlsoWhatOthersHaveNotKept) {
  Problems problems;
  problems.add(InputError({}, "a"));
  problems.attempt([] { throw InputErrors({"a", "b"}, 1005); });
  EXPECT_THAT(problems.messages(), ElementsAre("a", "b"));
  EXPECT_EQ(problems.count(), 1005u);  // 2 that are kept, 1003 that were not
}

TEST(Problems, AreNotToldWhatFollowsFromThem) {
  Problems problems;
  problems.add(Consequence({}, "a"));
  problems.add(Consequence({}, "b"));
  EXPECT_THAT(problems.messages(), ElementsAre("a"));
}

}  // namespace
}  // namespace frond
