#include "image/image_codec.h"

#include <gmock/gmock.h>

#include "tests/support/input_error.h"

namespace frond {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string refusal(const std::string& file) {
  return error_of([&] { open_image_codec(file); });
}

TEST(ImageCodec, LiesBesideTheLibrary) {
  EXPECT_TRUE(std::filesystem::exists(image_codec_file()));
  EXPECT_EQ(&image_codec(), &open_image_codec(image_codec_file()));
}

TEST(ImageCodec, WhatIsNoneIsRefusedWithAReason) {
  EXPECT_EQ(refusal("/no/such/lib.so"), "frond's library for image files \"/no/such/lib.so\": there is no such file");
  TestFolder folder("codec");
  EXPECT_THAT(refusal(folder.write("text.so", "not a shared object").string()),
              AllOf(HasSubstr("text.so\" cannot be loaded"), HasSubstr("file too short")));
  EXPECT_THAT(refusal(FROND_TEST_PLUGINS "/planted.so"), HasSubstr("planted.so\" has no function frond_image_codec"));
  EXPECT_THAT(refusal(FROND_TEST_PLUGINS "/other_codec.so"),
              HasSubstr("other_codec.so\" was compiled from other headers than this frond (core/math/vec.h)"));
}

}  // namespace
}  // namespace frond
