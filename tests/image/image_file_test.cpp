#include "image/image_file.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>

#include "tests/support/input_error.h"

#ifdef __SANITIZE_ADDRESS__
/// LeakSanitizer crashes when it searches thread-local memory of this program, which loads OpenImageIO.
extern "C" const char* __lsan_default_options() { return "use_tls=0"; }
#endif

namespace frond {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Files can grow to `bytes` and no further, as on a full disk, while this lives.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

class ImageFiles : public testing::Test {
 protected:
  ImageFiles() : folder_(fs::temp_directory_path() / fmt::format("frond_images_{}", getpid())) {
    fs::remove_all(folder_);
    fs::create_directory(folder_);
    unsetenv("SOURCE_DATE_EPOCH");
  }
  ~ImageFiles() override {
    unsetenv("SOURCE_DATE_EPOCH");
    fs::remove_all(folder_);
  }

  /// Values that identify their pixel and channel, some of them out of range.
  static Image sample(std::vector<std::string> channels, int width = 37, int height = 21) {
    Image image(width, height, std::move(channels));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (size_t c = 0; c < image.channels.size(); ++c)
          image.at(x, y, c) =
              static_cast<float>(c) * 1000.1f + static_cast<float>(x - 3) / 7 + static_cast<float>(y) * 1e-6f;
    return image;
  }
  static Image grey_ramp() {
    Image image(256, 2, {"R", "G", "B"});
    for (int x = 0; x < 256; ++x)
      for (int y = 0; y < 2; ++y)
        for (size_t c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(x) / 255;
    return image;
  }
  /// What lies in the folder.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
    return names;
  }

  fs::path folder_;
};

TEST_F(ImageFiles, ExrKeepsEveryFloatOfEveryChannelByName) {
  const Image image = sample({"R", "G", "B", "variance.R", "leaf"});
  write_image(folder_ / "a.exr", image, {});
  const ImageFile back = read_image(folder_ / "a.exr", {});
  ASSERT_EQ(back.image.channels.size(), 5u);
  EXPECT_EQ(back.image.width, 37);
  EXPECT_EQ(back.image.height, 21);
  EXPECT_FALSE(back.eight_bit);
  for (size_t c = 0; c < 5; ++c) {
    const auto channel = back.image.channel(image.channels[c]);
    ASSERT_TRUE(channel) << image.channels[c];
    for (int y = 0; y < 21; ++y)
      for (int x = 0; x < 37; ++x) ASSERT_EQ(back.image.at(x, y, *channel), image.at(x, y, c));
  }
  EXPECT_FALSE(back.image.channel("A"));
  EXPECT_THAT(files(), ElementsAre("a.exr"));
}

TEST_F(ImageFiles, HalfFloatsAreAskedForByName) {
  const Image image = sample({"R", "G", "B"});
  write_image(folder_ / "a.exr", image, {}, ExrDepth::half);
  const ImageFile back = read_image(folder_ / "a.exr", {});
  // 11 significant bits; denormals below 2^-14.
  for (size_t i = 0; i < image.pixels.size(); ++i)
    ASSERT_NEAR(back.image.pixels[i], image.pixels[i], std::abs(image.pixels[i]) * 0x1p-11f + 0x1p-25f);
}

TEST_F(ImageFiles, WhatHalvesCannotHoldBecomesInfinite) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Image image(6, 1, {"Y", "id"});
  image.pixels = {65504, 1e6f, 65519, 1e6f, 65520, 1e6f, -1e30f, 1e6f, kInfinity, 1e6f, std::nanf(""), 1e6f};
  ImageHeader header;
  header.full_precision = {"id"};
  write_image(folder_ / "a.exr", image, header, ExrDepth::half);
  const Image back = read_image(folder_ / "a.exr", {}).image;
  const auto at = [&](int x, const char* name) { return back.at(x, 0, *back.channel(name)); };
  const float expected[] = {65504, 65504, kInfinity, -kInfinity, kInfinity};
  for (int x = 0; x < 5; ++x) EXPECT_EQ(at(x, "Y"), expected[x]) << x;
  EXPECT_TRUE(std::isnan(at(5, "Y")));
  for (int x = 0; x < 6; ++x) EXPECT_EQ(at(x, "id"), 1e6f);
}

TEST_F(ImageFiles, WhatOpenExrRefusesIsAnInputError) {
  EXPECT_THAT(error_of([&] {
                write_image(folder_ / "a.exr", sample({"Y"}), {.color_space = "", .text = {{"", "no name"}}});
              }),
              HasSubstr("cannot encode an EXR: "));
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(ImageFiles, ExrSaysItsColorSpaceAndChromaticities) {
  for (const char* name : {"linear SMPTE-C", "linear sRGB", "ACEScg", "XYZ"}) {
    write_image(folder_ / "a.exr", sample({"R", "G", "B"}), {.color_space = name, .text = {}});
    const ImageFile back = read_image(folder_ / "a.exr", {});
    EXPECT_EQ(back.header.color_space, name);
    ASSERT_TRUE(back.chromaticities);
    const Chromaticities& expected = *chromaticities_of(name);
    EXPECT_FLOAT_EQ(float(back.chromaticities->red.x), float(expected.red.x));
    EXPECT_FLOAT_EQ(float(back.chromaticities->green.y), float(expected.green.y));
    EXPECT_FLOAT_EQ(float(back.chromaticities->blue.y), float(expected.blue.y));
    EXPECT_FLOAT_EQ(float(back.chromaticities->white.x), float(expected.white.x));
    EXPECT_FLOAT_EQ(float(back.chromaticities->white.y), float(expected.white.y));
  }
}

TEST_F(ImageFiles, TextAttributesComeBackWhole) {
  const std::map<std::string, std::string> text{{"frond:seed", "18446744073709551615"},
                                                {"frond:samples", "64"},
                                                {"frond:command", "frond render \"a b.pbrt\" --spp 64"}};
  write_image(folder_ / "a.exr", sample({"R", "G", "B"}), {.color_space = "", .text = text});
  const ImageFile back = read_image(folder_ / "a.exr", {});
  EXPECT_THAT(back.header.text, testing::IsSupersetOf(text));
  EXPECT_FALSE(back.chromaticities);
}

TEST_F(ImageFiles, SourceDateEpochFixesTheDateAndEveryByte) {
  setenv("SOURCE_DATE_EPOCH", "86399", 1);
  for (const char* name : {"a.exr", "b.exr", "a.png", "b.png"})
    write_image(folder_ / name, grey_ramp(), {"linear sRGB", {}});
  EXPECT_EQ(read_image(folder_ / "a.exr", {}).header.text.at("DateTime"), "1970:01:01 23:59:59");
  EXPECT_EQ(bytes_of(folder_ / "a.exr"), bytes_of(folder_ / "b.exr"));
  EXPECT_EQ(bytes_of(folder_ / "a.png"), bytes_of(folder_ / "b.png"));
  setenv("SOURCE_DATE_EPOCH", "yesterday", 1);
  EXPECT_EQ(error_of([&] { check_writable(folder_ / "c.exr"); }),
            "SOURCE_DATE_EPOCH is \"yesterday\", seconds since 1970 are needed");
}

TEST_F(ImageFiles, PngHoldsEightBitsExactly) {
  const Image image = grey_ramp();
  write_image(folder_ / "a.png", image, {});
  const ImageFile back = read_image(folder_ / "a.png", {});
  EXPECT_TRUE(back.eight_bit);
  EXPECT_THAT(back.image.pixels, testing::Pointwise(testing::FloatEq(), image.pixels));
}

TEST_F(ImageFiles, PngRoundsAndClampsAndDropsNothing) {
  Image image(5, 1, {"Y"});
  image.pixels = {-1, 0.4f / 255, 0.6f / 255, 254.6f / 255, 7};
  write_image(folder_ / "a.png", image, {});
  const ImageFile back = read_image(folder_ / "a.png", {});
  EXPECT_THAT(back.image.pixels, ElementsAre(0.f, 0.f, 1.f / 255, 1.f, 1.f));
}

TEST_F(ImageFiles, PngAlphaIsNotMultipliedIn) {
  Image image(1, 1, {"R", "G", "B", "A"});
  image.pixels = {1, 0.6f, 0.2f, 0.2f};
  write_image(folder_ / "a.png", image, {});
  const ImageFile back = read_image(folder_ / "a.png", {});
  for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(back.image.pixels[c], image.pixels[c], 1e-6) << c;
}

TEST_F(ImageFiles, JpegIsCloseAndUpperCaseWorks) {
  const Image image = grey_ramp();
  write_image(folder_ / "A.JPG", image, {});
  const ImageFile back = read_image(folder_ / "A.JPG", {});
  double square = 0;
  for (size_t i = 0; i < image.pixels.size(); ++i)
    square += std::pow(double(back.image.pixels[i] - image.pixels[i]), 2);
  // A smooth ramp at quality 95: about a step of 8 bits.
  EXPECT_LT(std::sqrt(square / double(image.pixels.size())), 2.0 / 255);
}

TEST_F(ImageFiles, ChannelsThatAFormatCannotHoldAreRefused) {
  EXPECT_THAT(error_of([&] {
                write_image(folder_ / "a.jpg", sample({"R", "G", "B", "A"}), {});
              }),
              HasSubstr("1 or 3 channels"));
  EXPECT_THAT(error_of([&] {
                write_image(folder_ / "a.png", sample({"a", "b", "c", "d", "e"}), {});
              }),
              HasSubstr("4 channels at most"));
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(ImageFiles, FullDiskIsAnErrorAndLeavesTheOldFile) {
  for (const char* name : {"a.exr", "a.png", "a.jpg"}) {
    const fs::path path = folder_ / name;
    std::ofstream(path) << "the old one";
    const std::string error = error_of([&] {
      const FullDisk full(100);
      write_image(path, sample({"R", "G", "B"}), {});
    });
    EXPECT_THAT(error, HasSubstr("cannot write \"" + path.string() + "\": File too large"));
    EXPECT_EQ(bytes_of(path), "the old one");
  }
  EXPECT_EQ(files().size(), 3u);
}

TEST_F(ImageFiles, FullDiskLeavesNoNewFile) {
  EXPECT_THAT(error_of([&] {
                const FullDisk full(100);
                write_image(folder_ / "a.exr", sample({"R", "G", "B"}), {});
              }),
              Not(IsEmpty()));
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(ImageFiles, PathsThatCannotBeWrittenAreRefusedBeforeRendering) {
  const auto refusal = [](const fs::path& path) { return error_of([&] { check_writable(path); }); };
  EXPECT_EQ(refusal(folder_ / "a.exr"), "");
  EXPECT_EQ(refusal(folder_ / "a.PNG"), "");
  EXPECT_THAT(refusal(folder_ / "a.gif"), HasSubstr("images are .exr, .png, .jpg or .jpeg"));
  EXPECT_THAT(refusal(folder_ / "a"), HasSubstr("images are .exr"));
  EXPECT_THAT(refusal(folder_ / "missing" / "a.exr"), HasSubstr("there is no folder"));
  EXPECT_THAT(refusal("/proc/a.exr"), HasSubstr("cannot write \"/proc/a.exr\": "));
  fs::create_directory(folder_ / "b.exr");
  EXPECT_THAT(refusal(folder_ / "b.exr"), HasSubstr("it is a folder"));
  fs::create_symlink("/dev/full", folder_ / "c.exr");
  EXPECT_THAT(refusal(folder_ / "c.exr"), HasSubstr("it is no regular file"));
  EXPECT_EQ(files().size(), 2u);
}

TEST_F(ImageFiles, SymbolicLinksAreFollowed) {
  fs::create_directory(folder_ / "there");
  write_image(folder_ / "there" / "a.exr", sample({"Y"}), {});
  fs::create_symlink(folder_ / "there" / "a.exr", folder_ / "link.exr");
  write_image(folder_ / "link.exr", sample({"R", "G", "B"}), {});
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.exr"));
  EXPECT_EQ(read_image(folder_ / "there" / "a.exr", {}).image.channels.size(), 3u);
}

TEST_F(ImageFiles, MissingFilesAreNamedWhereTheSceneAsksForThem) {
  const Location here{std::make_shared<const std::string>("scene.pbrt"), 3, 7};
  const fs::path path = folder_ / "no.png";
  EXPECT_EQ(error_of([&] { read_image(path, here); }),
            "scene.pbrt:3:7: cannot read image \"" + path.string() + "\": No such file or directory");
  EXPECT_THAT(error_of([&] { read_image(folder_, here); }), HasSubstr("cannot read image"));
  std::ofstream(folder_ / "text.png") << "no image";
  EXPECT_THAT(error_of([&] { read_image(folder_ / "text.png", here); }), HasSubstr("cannot read image"));
}

TEST_F(ImageFiles, TruncatedFilesAreErrors) {
  for (const char* name : {"a.exr", "a.png", "a.jpg"}) {
    const fs::path path = folder_ / name;
    write_image(path, sample({"R", "G", "B"}, 200, 200), {});
    const uintmax_t size = fs::file_size(path);
    for (const double fraction : {0.9, 0.5, 0.1, 0.0}) {
      fs::resize_file(path, static_cast<uintmax_t>(static_cast<double>(size) * fraction));
      EXPECT_THAT(error_of([&] { read_image(path, {}); }), HasSubstr("cannot read image \"" + path.string()))
          << name << " " << fraction;
    }
  }
}

TEST_F(ImageFiles, SmallFilesThatClaimHugeImagesAreRefused) {
  const fs::path path = folder_ / "a.exr";
  write_image(path, sample({"R", "G", "B"}), {});
  // The last corner of data and display windows, (36, 20), becomes (60000, 60000): 43 GB.
  std::string bytes = bytes_of(path);
  const auto little_endian = [](int x, int y) {
    std::string s;
    for (const int v : {x, y})
      for (int k = 0; k < 4; ++k) s += static_cast<char>(v >> (8 * k) & 255);
    return s;
  };
  const std::string corner = little_endian(36, 20), huge = little_endian(60000, 60000);
  size_t replaced = 0;
  for (size_t at = 0; (at = bytes.find(corner, at)) != std::string::npos; ++replaced) bytes.replace(at, 8, huge);
  ASSERT_EQ(replaced, 2u);
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_THAT(error_of([&] { read_image(path, {}); }), HasSubstr("a.exr"));
}

TEST_F(ImageFiles, SmallFilesWithHugeAttributesAreRefused) {
  const fs::path path = folder_ / "a.exr";
  write_image(path, sample({"R", "G", "B"}), {});
  std::string bytes = bytes_of(path);
  const size_t size = bytes.find(std::string("capDate\0string\0", 15)) + 15;
  bytes[size + 3] = 0x7f;  // the last byte of the attribute's size: 2 GB
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_THAT(error_of([&] { read_image(path, {}); }), HasSubstr("an attribute of its header claims 21307064"));
}

TEST_F(ImageFiles, CompressionsOfLaterVersionsOfOpenExrAreNamed) {
  const fs::path path = folder_ / "a.exr";
  write_image(path, sample({"R", "G", "B"}), {});
  std::string bytes = bytes_of(path);
  const std::string attribute("compression\0compression\0\x01\0\0\0", 28);
  bytes[bytes.find(attribute) + attribute.size()] = 10;
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_THAT(error_of([&] { read_image(path, {}); }), HasSubstr("compression 10 is not supported"));
}

/// Images of the fuzz target "image", whose first byte is not part of the file.
TEST_F(ImageFiles, ThatOpenImageIOFollowsBeyondTheirDataAreRefused) {
  const std::vector<std::array<std::string, 3>> kCases{
      {"exr_wide_data_window", "a.exr", "claims 10420256 x 24 pixels"},
      {"exr_huge_tiles", "a.exr", "are larger than its"},
      {"exr_hidden_tiles", "a.exr", "its list of channels has another size than it states"},
      {"exr_wide_dwab", "a.exr", "claims 262176 x 24 pixels"},
      {"tiff_endless_strip", "a.tif", "claims 32 x 2147483647 pixels"},
      {"tiff_huge_strip", "a.tif", "claims 32 x 67108864 pixels"},
      {"exr_subsampled_tiles", "a.exr", "it is subsampled"},
      {"exr_name_of_a_channel", "a.exr", "the name of a channel is not UTF-8"},
      {"cut_png", "a.png", "the file ends too soon"},
      {"png_long_chunk", "a.png", "the file ends too soon"},
      {"bmp_compressed_0", "a.bmp", "compressed BMP is not supported"},
      {"tga_with_a_palette", "a.tga", "TGA with a palette is not supported"},
      {"tiff_huge_tiles", "a.tif", "are larger than its"},
      {"tiff_without_bits", "a.tif", "its header has no BitsPerSample"},
      {"tiff_lzw_damaged", "a.tif", "cannot read image"},
      {"tiff_deflate_damaged", "a.tif", "cannot read image"}};
  for (const auto& [input, name, message] : kCases) {
    const fs::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << bytes_of(FROND_SOURCE_DIR "/tests/fuzz/corpus/image/" + input).substr(1);
    EXPECT_THAT(error_of([&] { read_image(path, {}); }), HasSubstr(message)) << input;
  }
}

/// OpenEXR takes the pixels of an empty chunk from uninitialised memory.
TEST_F(ImageFiles, PixelsWithoutDataAreBlack) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer fills memory that is allocated with numbers of its own";
#endif
  const fs::path path = folder_ / "a.exr";
  std::ofstream(path, std::ios::binary)
      << bytes_of(FROND_SOURCE_DIR "/tests/fuzz/corpus/image/exr_empty_chunk").substr(1);
  for (int i = 0; i < 20; ++i) {
    for (size_t size = 16; size < 4096; size += 16) std::string(size, 'x').swap(*std::make_unique<std::string>());
    EXPECT_THAT(read_image(path, {}).image.pixels, testing::Each(0.0f));
  }
}

/// A BMP with 16 of the 256 colours that its pixels can name.
TEST_F(ImageFiles, ShortPalettesAreRefused) {
  constexpr std::array<uint16_t, 27> kBmp{0x4d42, 0, 0, 0, 0, 118, 0, 40, 0, 4,  0, 1, 0, 1,
                                          8,      0, 0, 0, 0, 0,   0, 0,  0, 16, 0, 0, 0};
  const fs::path path = folder_ / "a.bmp";
  std::ofstream(path, std::ios::binary) << std::string(reinterpret_cast<const char*>(kBmp.data()), sizeof kBmp)
                                        << std::string(64, '\0') << std::string(4, '\xff');
  EXPECT_THAT(error_of([&] { read_image(path, {}); }), HasSubstr("its palette has 16 of 256 colours"));
}

/// 24 MB of pixels, for which OpenImageIO would allocate 3 GB.
TEST_F(ImageFiles, SmallFilesThatClaimWideRowsAreRefused) {
  constexpr std::array<uint16_t, 27> kBmp{0x4d42, 78, 0, 0, 0, 54, 0, 40, 0, 2, 63, 2, 0, 1, 24};
  const std::string bytes(reinterpret_cast<const char*>(kBmp.data()), sizeof kBmp);
  const fs::path path = folder_ / "a.bmp";
  std::ofstream(path, std::ios::binary) << bytes + std::string(24, '\0');
  EXPECT_THAT(error_of([&] { read_image(path, {}); }), HasSubstr("claims 4128770 x 2 pixels"));
}

TEST_F(ImageFiles, ThatEndTooSoonAreRefusedWhereverTheyEnd) {
  for (const char* name : {"t.png", "t.jpg", "t.exr"}) {
    const fs::path path = folder_ / name;
    write_image(path, sample({"R", "G", "B"}), {});
    const std::string whole = bytes_of(path);
    for (size_t size = 0; size < whole.size(); size += whole.size() / 40 + 1) {
      std::ofstream(path, std::ios::binary) << whole.substr(0, size);
      EXPECT_THAT(error_of([&] { read_image(path, {}); }), HasSubstr(name)) << size << " of " << whole.size();
    }
  }
}

}  // namespace
}  // namespace frond
