#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <functional>

#include "image/image_file.h"
#include "tests/support/input_error.h"

/// Each format with alpha that is read, with the same pixels: colours are the file's, not multiplied by alpha.
namespace frond {
namespace {

using Pixel = std::array<uint8_t, 4>;
using Pixels = std::array<Pixel, 4>;  // 2 x 2, from the top left
constexpr Pixels kPixels{{{20, 180, 60, 128}, {200, 10, 90, 0}, {7, 8, 9, 255}, {255, 128, 64, 1}}};

template <class T>
std::string little(T number) {
  std::string bytes;
  for (size_t i = 0; i < sizeof number; ++i) bytes += char(number >> 8 * i & 0xff);
  return bytes;
}

std::string rgba(const Pixels& pixels) {
  std::string bytes;
  for (const Pixel& p : pixels) bytes.append(p.begin(), p.end());
  return bytes;
}
/// From the bottom row, if `upwards`.
std::string bgra(const Pixels& pixels, bool upwards) {
  std::string bytes;
  for (const size_t i : upwards ? std::array<size_t, 4>{2, 3, 0, 1} : std::array<size_t, 4>{0, 1, 2, 3})
    for (const size_t c : {2, 1, 0, 3}) bytes += char(pixels[i][c]);
  return bytes;
}

Pixels multiplied(Pixels pixels) {
  for (Pixel& p : pixels)
    for (size_t c = 0; c < 3; ++c) p[c] = uint8_t(std::lround(p[c] * p[3] / 255.));
  return pixels;
}

/// TIFF 6.0, uncompressed. `extra`: value of ExtraSamples, -1 for none.
std::string tiff(const Pixels& pixels, int extra) {
  const std::vector<std::array<uint32_t, 4>> entries{
      // tag, type, count, value
      {256, 3, 1, 2},   {257, 3, 1, 2}, {258, 3, 4, 200}, {259, 3, 1, 1},  {262, 3, 1, 2},
      {273, 4, 1, 208}, {277, 3, 1, 4}, {278, 3, 1, 2},   {279, 4, 1, 16}, {338, 3, 1, uint32_t(extra)}};
  const size_t count = entries.size() - (extra < 0);
  std::string bytes = "II*" + std::string(1, '\0') + little(uint32_t{8}) + little(uint16_t(count));
  for (size_t i = 0; i < count; ++i) {
    const auto& [tag, type, values, value] = entries[i];
    bytes += little(uint16_t(tag)) + little(uint16_t(type)) + little(values) + little(value);
  }
  bytes += little(uint32_t{0});
  bytes.resize(200);
  for (int i = 0; i < 4; ++i) bytes += little(uint16_t{8});
  return bytes + rgba(pixels);
}

/// TGA 2.0. `alpha_type`: field 24 of the extension area, -1 for none.
std::string tga(const Pixels& pixels, int alpha_type) {
  std::string bytes(18, '\0');
  bytes[2] = 2, bytes[12] = 2, bytes[14] = 2, bytes[16] = 32, bytes[17] = 0x28;
  bytes += bgra(pixels, false);
  if (alpha_type < 0) return bytes;
  const auto area = uint32_t(bytes.size());
  bytes += little(uint16_t{495}) + std::string(493, '\0');
  bytes.back() = char(alpha_type);
  return bytes + little(area) + little(uint32_t{0}) + "TRUEVISION-XFILE." + std::string(1, '\0');
}

std::string bmp(const Pixels& pixels) {
  return "BM" + little(uint32_t{70}) + little(uint32_t{0}) + little(uint32_t{54}) + little(uint32_t{40}) +
         little(uint32_t{2}) + little(uint32_t{2}) + little(uint16_t{1}) + little(uint16_t{32}) +
         std::string(24, '\0') + bgra(pixels, true);
}

/// kPixels by libwebp: lossless, exact (colours where alpha is 0 are kept).
constexpr unsigned char kWebp[] = {0x52, 0x49, 0x46, 0x46, 0x3c, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50,
                                   0x38, 0x4c, 0x2f, 0x00, 0x00, 0x00, 0x2f, 0x01, 0x40, 0x00, 0x10, 0x1f, 0x20, 0xa6,
                                   0x21, 0x73, 0x9b, 0x4b, 0x20, 0xd9, 0x08, 0x09, 0x88, 0x68, 0x81, 0x2d, 0xf6, 0x7b,
                                   0x26, 0x24, 0x20, 0xb2, 0x79, 0xfe, 0x77, 0x2b, 0x04, 0x01, 0x49, 0x82, 0xcb, 0x9b,
                                   0x5e, 0x08, 0xb3, 0x2e, 0x79, 0xf8, 0x01, 0x42, 0x44, 0xff, 0x43, 0x00};

class Alpha : public testing::Test {
 protected:
  ImageFile file_of(const std::string& name, const std::string& bytes) const {
    return read_image(folder_.write(name, bytes), {});
  }
  /// Colours equal kPixels where alpha determines them: `is_known`, by alpha.
  static void expect_pixels(const Image& image, const std::string& name, const std::function<bool(int)>& is_known) {
    SCOPED_TRACE(name);
    ASSERT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    for (size_t i = 0; i < kPixels.size(); ++i)
      for (size_t c = 0; c < 4; ++c) {
        if (c < 3 && !is_known(kPixels[i][3])) continue;
        const double rounding = c < 3 && kPixels[i][3] == 128 ? 1.01 : 1e-4;  // of values that were multiplied by 1/2
        EXPECT_NEAR(image.pixels[4 * i + c] * 255, kPixels[i][c], rounding) << i << ' ' << c;
      }
  }

  TestFolder folder_{"alpha"};
};

TEST_F(Alpha, ColoursAreThoseOfTheFileInEachFormat) {
  Image image(2, 2, {"R", "G", "B", "A"});
  for (size_t i = 0; i < 16; ++i) image.pixels[i] = float(kPixels[i / 4][i % 4]) / 255;
  write_image(folder_.name_of("a.png"), image, {});
  write_image(folder_.name_of("a.exr"), image, {});
  const auto all = [](int) { return true; };
  for (const char* name : {"a.png", "a.exr"}) expect_pixels(read_image(folder_.name_of(name), {}).image, name, all);
  const std::string webp(reinterpret_cast<const char*>(kWebp), sizeof kWebp);
  for (const auto& [name, bytes] : {std::pair{"a.webp", webp},
                                    {"unassociated.tif", tiff(kPixels, 2)},
                                    {"unstated.tif", tiff(kPixels, -1)},
                                    {"plain.tga", tga(kPixels, -1)},
                                    {"useful.tga", tga(kPixels, 3)},
                                    {"a.bmp", bmp(kPixels)}}) {
    const ImageFile file = file_of(name, bytes);
    EXPECT_TRUE(file.eight_bit && file.is_encoded) << name;
    expect_pixels(file.image, name, all);
  }
}

TEST_F(Alpha, StatedMultiplicationByAlphaIsUndone) {
  const Pixels pixels = multiplied(kPixels);
  const auto known = [](int alpha) { return alpha > 1; };  // 1/255 leaves a bit of each colour
  for (const auto& [name, bytes] :
       {std::pair{"associated.tif", tiff(pixels, 1)}, {"premultiplied.tga", tga(pixels, 4)}}) {
    const Image image = file_of(name, bytes).image;
    expect_pixels(image, name, known);
    EXPECT_EQ(image.pixels[4], 0) << "of alpha 0 no colour is known";
    for (const float v : image.pixels) EXPECT_TRUE(v >= 0 && v <= 1) << name;
  }
}

TEST_F(Alpha, DamagedWebpIsRefused) {
  const std::string webp(reinterpret_cast<const char*>(kWebp), sizeof kWebp);
  EXPECT_THAT(error_of([&] { file_of("cut.webp", webp.substr(0, 50)); }), testing::HasSubstr("cut.webp\": its "));
  EXPECT_THAT(error_of([&] { file_of("head.webp", webp.substr(0, 22)); }), testing::HasSubstr("head.webp\": its "));
}

}  // namespace
}  // namespace frond
