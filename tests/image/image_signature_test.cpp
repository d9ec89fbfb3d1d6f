#include "image/image_signature.h"

#include <gmock/gmock.h>

#include "image/image_file.h"
#include "tests/support/input_error.h"

// Formats are recognised by content, and no other reader of OpenImageIO than the format's is ever called.

namespace frond {
namespace {

using namespace std::string_literals;
using testing::HasSubstr;

std::string format(const std::string& bytes, const char* name = "f.png") {
  return std::string(image_format_of(bytes, name, {}));
}
std::string refusal_of_bytes(const std::string& bytes, const char* name = "f.png") {
  return error_of([&] { image_format_of(bytes, name, {}); });
}

/// Header of a TGA of 2 x 3 pixels of 24 bits, and its pixels.
std::string tga() { return "\0\0\2\0\0\0\0\0\0\0\0\0\2\0\3\0\x18\0"s + std::string(18, '\x40'); }

TEST(ImageSignatures, AreThoseOfTheFormatsThatAreRead) {
  EXPECT_EQ(format("\x76\x2f\x31\x01\2\0\0\0"s), "openexr");
  EXPECT_EQ(format("\x89PNG\r\n\x1a\n"), "png");
  EXPECT_EQ(format("\xff\xd8\xff\xe0"), "jpeg");
  EXPECT_EQ(format("#?RADIANCE\n"), "hdr");
  EXPECT_EQ(format("II*\0"s), "tiff");
  EXPECT_EQ(format("MM\0+"s), "tiff");
  EXPECT_EQ(format("RIFF\1\0\0\0WEBPVP8 "s), "webp");
  EXPECT_EQ(format("PF\n1 1\n-1\n"), "pnm");
  EXPECT_EQ(format("Pf 1 1\n-1\n"), "pnm");
  EXPECT_EQ(format("BM"s + std::string(12, '\0') + "\x28\0\0\0"s), "bmp");
  EXPECT_EQ(format(tga(), "f.TGA"), "targa");
}

TEST(ImageSignatures, OtherFormatsAreRefusedByName) {
  EXPECT_EQ(
      refusal_of_bytes("FOR4\0\0\0\x10"
                       "CIMG"s),
      "cannot read image \"f.png\": its format is IFF; images are EXR, PNG, JPEG, HDR, TIFF, PFM, BMP, WebP or TGA");
  EXPECT_THAT(refusal_of_bytes("SDPX"), HasSubstr("its format is DPX"));
  EXPECT_THAT(refusal_of_bytes("GIF89a"), HasSubstr("its format is GIF"));
  EXPECT_THAT(refusal_of_bytes("P6\n1 1\n255\n"), HasSubstr("its format is Netpbm"));
  EXPECT_THAT(refusal_of_bytes("#EXTM3U\nhttp://host/a.ts\n", "v.avi"), HasSubstr("its format is playlist"));
  EXPECT_THAT(refusal_of_bytes("\0\0\0\x18"
                               "ftypmp42"s,
                               "v.mp4"),
              HasSubstr("its format is HEIF, AVIF or MP4"));
  EXPECT_THAT(refusal_of_bytes("RIFF\1\0\0\0AVI LIST"s), HasSubstr("its format is AVI"));
  EXPECT_THAT(refusal_of_bytes("BM and other text that begins so"), HasSubstr("its content is that of no image"));
  EXPECT_THAT(refusal_of_bytes("", "x.null"), HasSubstr("\"x.null\": the file is empty"));
}

/// TGA has no signature: any bytes could be one.
TEST(ImageSignatures, TgaNeedsItsExtensionAndAValidHeader) {
  EXPECT_THAT(refusal_of_bytes(tga(), "f.png"), HasSubstr("that of no image"));
  constexpr std::pair<size_t, char> kFaults[] = {{1, 1}, {2, 7}, {2, 1}, {12, 0}, {14, 0}, {16, 5}, {17, '\xc0'}};
  for (const auto& [at, value] : kFaults) {
    std::string bytes = tga();
    bytes[at] = value;
    EXPECT_THAT(refusal_of_bytes(bytes, "f.tga"), HasSubstr("cannot read image")) << at;
  }
  EXPECT_THAT(refusal_of_bytes(tga().substr(0, 18), "f.tga"), HasSubstr("that of no image"));
}

/// When the name chose the reader, these files corrupted the heap, crashed the program or did not terminate.
TEST(ImageSignatures, MisleadingNamesReachNoOtherReader) {
  const TestFolder folder("signatures");
  for (const char* name : {"f.png", "g.exr", "x.null", "v.avi", "v.mp4", "d.dpx", "r.rla", "a.iff", "n.vdb", "t.term"})
    for (const std::string& bytes : {""s, "FOR4\0\0\1\0CIMGTBHD"s + std::string(300, '\xff'), "#EXTM3U\nv.avi\n"s,
                                     "SDPX"s + std::string(3000, '\x7f'), std::string(740, '\1')})
      EXPECT_THAT(error_of([&] { read_image(folder.write(name, bytes), {}); }), HasSubstr("cannot read image"))
          << name << " " << bytes.substr(0, 4);
}

TEST(ImageSignatures, ContentDecidesWhatTheNameDoesNot) {
  const TestFolder folder("signatures");
  const ImageFile pfm = read_image(folder.write("a.png", "Pf\n2 1\n-1.0\n\0\0\x80\x3f\0\0\0\x40"s), {});
  EXPECT_THAT(pfm.image.pixels, testing::ElementsAre(1, 2));
  EXPECT_EQ(read_image(folder.write("a.tga", tga()), {}).image.height, 3);
}

/// Sizes whose products overflow, and none.
TEST(ImageSignatures, SizesThatNoFileHoldsAreRefusedWithTheFileName) {
  const TestFolder folder("signatures");
  for (const char* size : {"2147483647 2147483647", "-1 5", "0 0", "99999999999999999999 1", "65536 65536"})
    EXPECT_THAT(error_of([&] { read_image(folder.write("a.pfm", fmt::format("PF\n{}\n-1.0\n", size)), {}); }),
                HasSubstr("a.pfm"))
        << size;
}

}  // namespace
}  // namespace frond
