#include "imports/obj_origin.h"

#include <gtest/gtest.h>

namespace frond {
namespace {

using Origin = std::array<double, 3>;

TEST(ObjOrigin, LeavesWhatIsNear) {
  const std::string near = "v 1 2 3\nv 200 0 0\nf 1 2 2\n";
  std::string text = near;
  EXPECT_EQ(move_obj_to_origin(text), Origin());
  EXPECT_EQ(text, near);
}

TEST(ObjOrigin, SubtractsInDoublePrecision) {
  std::string text =
      "# v 1 2 3\r\nmtllib a.mtl\r\nv 500000.4375 5200000.75 312.25\r\n  v\t500000.5625 5200000.75 312.25 .1 .2 .3\r\n"
      "v 500000.5625 5200001.125 312.25\r\nvn 0 0 1\nvt 0 0\n\nusemtl leaf\nf 1 2 3";
  EXPECT_EQ(move_obj_to_origin(text), (Origin{500001, 5200001, 312}));
  EXPECT_EQ(text,
            "# v 1 2 3\r\nmtllib a.mtl\r\nv -0.5625 -0.25 0.25\r\nv -0.4375 -0.25 0.25 .1 .2 .3\r\n"
            "v -0.4375 0.125 0.25\r\nvn 0 0 1\nvt 0 0\n\nusemtl leaf\nf 1 2 3");
}

TEST(ObjOrigin, LeavesVerticesThatAreNotThreeNumbers) {
  for (const char* strange :
       {"v 500000 1 2 0.5\n", "v 500000,1 1 2\n", "v 500000 nan 2\n", "v 500000 1\n", "v 5e5 1 2\\\n"}) {
    std::string text = strange;
    EXPECT_EQ(move_obj_to_origin(text), Origin()) << strange;
    EXPECT_EQ(text, strange);
  }
}

}  // namespace
}  // namespace frond
