#include "render/parts/part.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>

#include "core/log.h"
#include "core/math/random.h"
#include "image/image_file.h"
#include "render/image_output.h"
#include "render/parts/part_file.h"
#include "tests/render/render_scene.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;
using test::a_scene;
using test::SceneRender;

const std::vector<std::string> kAllChannels{"albedo", "normal", "depth", "position", "material", "instance", "samples"};
const std::vector<std::string> kChannelsOfBands{"normal", "depth", "position", "material", "instance", "samples"};

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Parts : public ::testing::Test {
 protected:
  void SetUp() override {
    setenv("SOURCE_DATE_EPOCH", "0", 1);
    scene_ = folder_.write("scene.pbrt", a_scene());
  }
  fs::path path(const std::string& name) const { return folder_.name_of(name); }
  fs::path write(const RenderPart& part, const std::string& name) const {
    write_part(path(name), part.header, part.film);
    return path(name);
  }
  RenderPart part(SampleRange samples, SceneRender how = {}) const { return how.part(scene_, samples); }
  /// The image's file.
  std::string image_of(const RenderPart& part) const {
    ImageOutput(path("image.exr").string(), {}).write(part.film, finished_format(part));
    return bytes_of(path("image.exr"));
  }
  /// Error of merging two parts.
  std::string refusal(const RenderPart& a, const RenderPart& b) const {
    const auto files = {write(a, "a.part"), write(b, "b.part")};
    return error_of([&] { merge_parts(files); });
  }

  TestFolder folder_{"parts"};
  fs::path scene_;
};

/// Pieces of the image, all of it, without regard to tiles.
std::vector<Crop> pieces_of_the_image() { return {{0, 0, 13, 9}, {13, 0, 40, 9}, {0, 9, 21, 27}, {21, 9, 40, 27}}; }

struct Case {
  std::string name, wavelengths;
  std::vector<std::string> channels;
  std::string filter = {};
};
std::vector<Case> cases() {
  return {{"colours", "hero", {}},
          {"channels", "hero", kAllChannels},
          {"bands", "bands,lambdamin=400,lambdamax=700,step=50", {}},
          {"bands and channels", "bands,lambdamin=400,lambdamax=700,step=50", kChannelsOfBands, "box"},
          {"negative weights", "hero", {}, "sinc"},
          {"samples of their own", "hero", kAllChannels, "mitchell,reconstruction=importance"}};
}

TEST_F(Parts, RangesOfSamplesAddUpToTheWhole) {
  std::mt19937 random(1);
  for (const Case& c : cases()) {
    const SceneRender how{.wavelengths = c.wavelengths, .channels = c.channels, .filter = c.filter};
    const RenderPart whole = part({0, 37}, how);
    const std::string image = image_of(whole);
    std::vector<fs::path> files;
    for (const auto& range : {SampleRange{0, 5}, {5, 16}, {16, 37}})
      files.push_back(write(part(range, how), fmt::format("{}.part", range.begin)));
    for (int i = 0; i < 4; ++i) {
      std::ranges::shuffle(files, random);
      const RenderPart merged = merge_parts(files);
      EXPECT_EQ(merged.film, whole.film) << c.name;
      EXPECT_EQ(image_of(merged), image) << c.name;
      EXPECT_EQ(merged.header.statistics.paths, whole.header.statistics.paths);
      EXPECT_EQ(merged.header.statistics.rays, whole.header.statistics.rays);
    }
  }
}

TEST_F(Parts, PiecesOfTheImageAddUpToTheWhole) {
  std::mt19937 random(2);
  for (const Case& c : cases()) {
    SceneRender how{.wavelengths = c.wavelengths, .channels = c.channels, .filter = c.filter};
    const RenderPart whole = part({0, 20}, how);
    std::vector<fs::path> files;
    for (const Crop& pixels : pieces_of_the_image())
      for (const auto& range : {SampleRange{0, 7}, {7, 20}}) {
        how.pixels = pixels;
        files.push_back(write(part(range, how), fmt::format("{}.part", files.size())));
      }
    for (int i = 0; i < 6; ++i) {
      std::ranges::shuffle(files, random);
      const RenderPart merged = merge_parts(files);
      EXPECT_EQ(merged.film, whole.film) << c.name;
      EXPECT_EQ(image_of(merged), image_of(whole)) << c.name;
      EXPECT_EQ(missing_samples_text(merged), "");
    }
  }
}

TEST_F(Parts, MergedPartsCanBeMergedAgain) {
  const RenderPart whole = part({0, 12});
  std::vector<fs::path> files;
  for (uint64_t s = 0; s < 12; s += 3) files.push_back(write(part({s, s + 3}), fmt::format("{}.part", s)));
  const auto left = write(merge_parts({files[0], files[2]}), "left.part"),
             right = write(merge_parts({files[3], files[1]}), "right.part");
  EXPECT_EQ(merge_parts({right, left}).film, whole.film);
  EXPECT_EQ(image_of(merge_parts({right, left})), image_of(whole));
}

TEST_F(Parts, AnyNumberOfThreadsIsTheSame) {
  for (const Case& c : cases()) {
    SceneRender how{.wavelengths = c.wavelengths, .channels = c.channels, .threads = 1, .filter = c.filter};
    const RenderPart one = part({3, 40}, how);
    for (const int threads : {2, 7}) {
      how.threads = threads;
      const RenderPart many = part({3, 40}, how);
      EXPECT_EQ(many.film, one.film) << c.name;
      EXPECT_EQ(image_of(many), image_of(one)) << c.name;
    }
  }
}

TEST_F(Parts, AFileHoldsAllOfAPart) {
  for (const Case& c : cases()) {
    const RenderPart before = part({2, 9}, {.wavelengths = c.wavelengths, .channels = c.channels, .filter = c.filter});
    const RenderPart after = read_part(write(before, "a.part"));
    EXPECT_EQ(after.film, before.film);
    EXPECT_EQ(after.header.identity, before.header.identity);
    EXPECT_EQ(encode_part(after.header, after.film), encode_part(before.header, before.film)) << c.name;
  }
}

TEST_F(Parts, WhatIsThereTwiceIsRefused) {
  EXPECT_THAT(refusal(part({0, 9}), part({5, 12})),
              AllOf(HasSubstr("a.part"), HasSubstr("b.part"), HasSubstr("samples 5:9")));
  EXPECT_THAT(refusal(part({0, 9}), part({0, 9})), HasSubstr("samples 0:9"));
  SceneRender left{.pixels = Crop{0, 0, 20, 27}}, right{.pixels = Crop{19, 3, 40, 27}};
  EXPECT_THAT(refusal(part({0, 4}, left), part({0, 4}, right)),
              AllOf(HasSubstr("a.part"), HasSubstr("b.part"), HasSubstr("of pixels 19,20,3,16")));
  // The error names the two parts.
  const auto files = {write(part({0, 2}), "0.part"), write(part({4, 6}), "1.part"), write(part({2, 4}), "2.part"),
                      write(part({5, 7}), "3.part")};
  EXPECT_THAT(error_of([&] { merge_parts(files); }), AllOf(HasSubstr("1.part"), HasSubstr("3.part"), HasSubstr("5:6")));
}

TEST_F(Parts, HolesAreNamed) {
  const auto missing = [this](const std::vector<RenderPart>& parts) {
    std::vector<fs::path> files;
    for (const RenderPart& p : parts) files.push_back(write(p, fmt::format("{}.part", files.size())));
    return missing_samples_text(merge_parts(files));
  };
  std::vector<RenderPart> parts;
  parts.push_back(part({0, 4}));
  parts.push_back(part({6, 8}));
  EXPECT_THAT(missing(parts), HasSubstr("samples 4:6"));
  parts.erase(parts.begin());
  EXPECT_THAT(missing(parts), HasSubstr("samples 0:6"));
  parts.clear();
  for (const Crop& pixels : pieces_of_the_image()) parts.push_back(part({0, 3}, {.pixels = pixels}));
  EXPECT_EQ(missing(parts), "");
  parts.erase(parts.begin() + 1);
  EXPECT_THAT(missing(parts), HasSubstr("samples 0:3 of pixels 13,16,0,9"));
}

TEST_F(Parts, OfOtherRendersAreRefusedByWhatDiffers) {
  const RenderPart first = part({0, 2});
  const auto with = [this](const SceneRender& how) { return part({2, 4}, how); };
  EXPECT_EQ(refusal(first, with({})), "");
  EXPECT_THAT(refusal(first, with({.seed = 2})),
              AllOf(HasSubstr("seed: 1 in"), HasSubstr("a.part"), HasSubstr("2 in")));
  EXPECT_THAT(refusal(first, with({.wavelengths = "smpte"})), HasSubstr("wavelengths: hero"));
  EXPECT_THAT(refusal(first, with({.swap = "diffuse"})), HasSubstr("materials: "));
  EXPECT_THAT(refusal(first, with({.channels = {"depth"}})), HasSubstr("channels: "));
  EXPECT_THAT(refusal(first, with({.integrator = "path,maxdepth=1"})), HasSubstr("integrator: path"));
}

TEST_F(Parts, OfChangedFilesAreRefusedByTheirNames) {
  const std::string with_mesh = a_scene("Shape \"plymesh\" \"string filename\" \"triangle.ply\"\n");
  folder_.write("triangle.ply", test::triangle(0.5));
  folder_.write("scene.pbrt", with_mesh);
  const RenderPart first = part({0, 2});
  folder_.write("triangle.ply", test::triangle(0.25));
  EXPECT_THAT(refusal(first, part({2, 4})), HasSubstr("file triangle.ply: "));
  folder_.write("triangle.ply", test::triangle(0.5));
  EXPECT_EQ(refusal(first, part({2, 4})), "");
  folder_.write("scene.pbrt", with_mesh + "# other\n");
  EXPECT_THAT(refusal(first, part({2, 4})), HasSubstr("scene: "));
  folder_.write("scene.pbrt", a_scene("", 20));
  EXPECT_THAT(refusal(first, part({2, 4})), AnyOf(HasSubstr("resolution: 40 x 27 in"), HasSubstr("scene: ")));
}

/// Error of reading these bytes. A part that is read without an error must equal `original`.
std::string complaint(const std::vector<unsigned char>& bytes, const RenderPart& original) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::string said = error_of([&] {
    const RenderPart read = decode_part(text, "x.part");
    EXPECT_EQ(read.film, original.film);
    EXPECT_EQ(read.header.identity, original.header.identity);
    EXPECT_EQ(encode_part(read.header, read.film), encode_part(original.header, original.film));
  });
  if (!said.empty()) {
    EXPECT_THAT(said, HasSubstr("x.part"));
  }
  return said;
}

TEST_F(Parts, CutShortTheyAreRefused) {
  const RenderPart whole = part({0, 5}, {.channels = kAllChannels});
  const std::vector<unsigned char> bytes = encode_part(whole.header, whole.film);
  std::mt19937 random(3);
  std::vector<size_t> lengths{0, 1, 10, 11, 12, 13, 14, 20, 21, 22, bytes.size() - 1, bytes.size() - 15};
  for (int i = 0; i < 300; ++i) lengths.push_back(random() % bytes.size());
  for (const size_t length : lengths) {
    std::vector<unsigned char> cut(bytes.begin(), bytes.begin() + ptrdiff_t(length));
    EXPECT_NE(complaint(cut, whole), "") << length;
    // Also where the end looks as it should.
    cut.insert(cut.end(), bytes.end() - 15, bytes.end());
    if (length < bytes.size() - 15) {
      EXPECT_NE(complaint(cut, whole), "") << length;
    }
  }
}

TEST_F(Parts, WithAnyByteFlippedTheyAreNotReadAsSomethingElse) {
  const RenderPart whole = part({0, 5}, {.channels = kAllChannels});
  const std::vector<unsigned char> bytes = encode_part(whole.header, whole.film);
  std::mt19937 random(4);
  size_t refused = 0, flips = 0;
  const auto flip = [&](size_t place, unsigned char bits) {
    std::vector<unsigned char> flipped = bytes;
    flipped[place] ^= bits;
    ++flips;
    refused += complaint(flipped, whole).empty() ? 0 : 1;
  };
  for (int i = 0; i < 1000; ++i)
    flip(random() % bytes.size(), static_cast<unsigned char>(i % 2 ? 1 << random() % 8 : 1 + random() % 255));
  // At the beginning of the sums each bit is significant, except for two bits in the frame of the compressor.
  const std::string text(bytes.begin(), bytes.end());
  const size_t frame = text.find("\x28\xb5\x2f\xfd");
  ASSERT_NE(frame, std::string::npos);
  for (size_t place = frame - 8; place < frame + 16; ++place)
    for (int bit = 0; bit < 8; ++bit) flip(place, static_cast<unsigned char>(1 << bit));
  EXPECT_GE(refused, flips - 16);
}

TEST_F(Parts, WhatIsNoneOrOfAnotherVersionIsRefused) {
  const RenderPart whole = part({0, 1});
  const auto reading = [this](std::string_view bytes) {
    const fs::path file = folder_.write("x.part", bytes);
    const std::string head = error_of([&] { read_part_head(file); }), all = error_of([&] { read_part(file); });
    EXPECT_EQ(head, all);
    EXPECT_THAT(all, HasSubstr("x.part"));
    return all;
  };
  for (const std::string_view text : {"", "frond", "a scene\n", "\x76\x2f\x31\x01"})
    EXPECT_THAT(reading(text), HasSubstr("is not a part file"));
  const auto bytes = encode_part(whole.header, whole.film);
  std::string other(bytes.begin(), bytes.end());
  other[other.find('4')] = '3';
  EXPECT_THAT(reading(other), AllOf(HasSubstr("another version"), HasSubstr("version 4")));
  EXPECT_THAT(error_of([this] { read_part(path("none.part")); }), HasSubstr("none.part"));
  EXPECT_THAT(error_of([this] { merge_parts({path("scene.pbrt")}); }), HasSubstr("not a part file"));
}

/// A part of an adaptive render contains more data.
TEST_F(Parts, WithAndWithoutNoiseDoNotGoTogether) {
  const RenderPart plain = part({16, 32}), adaptive = part({0, 16}, {.adaptive = true});
  for (const std::string& said : {refusal(plain, adaptive), refusal(adaptive, plain)})
    EXPECT_THAT(said, AllOf(HasSubstr("--max-rms"), HasSubstr("a.part"), HasSubstr("b.part")));
}

/// A part whose header has `to` in place of `from`, with the size and the hash of that header.
std::string forged(const std::string& bytes, const std::string& from, const std::string& to) {
  const size_t size_at = bytes.find('\n') + 1, text_at = size_at + sizeof(uint64_t);
  uint64_t size = 0;
  std::memcpy(&size, bytes.data() + size_at, sizeof size);
  std::string text = bytes.substr(text_at, size);
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  const auto number = [](uint64_t n) { return std::string(reinterpret_cast<const char*>(&n), sizeof n); };
  return bytes.substr(0, size_at) + number(text.size()) + text + number(hash_bytes(text)) +
         bytes.substr(text_at + size + sizeof(uint64_t));
}

/// Numbers that overflow where they are added or multiplied before they are checked, or that convert to no integer.
TEST_F(Parts, ForgedHeadersAreDamaged) {
  const std::string bytes = bytes_of(write(part({0, 4}), "a.part"));
  const auto refusal = [&](const std::string& from, const std::string& to) {
    const fs::path path = folder_.write("f.part", forged(bytes, from, to));
    return error_of([&] { read_part(path); });
  };
  const auto number_of = [&](const std::string& name) {
    const size_t at = bytes.find('"' + name + "\": ");
    return bytes.substr(at, bytes.find_first_of(",\n", at) - at);
  };
  EXPECT_EQ(refusal("\"round\": 0", "\"round\": 0"), "");
  for (const char* name : {"width", "height", "bands", "exponent", "paths", "round", "request", "pixel_scale"})
    for (const char* value : {"1e300", "-9223372036854775808", "18446744073709551615", "2147483648", "\"x\"", "null"}) {
      const bool fits = std::string_view(value) == "18446744073709551615" || std::string_view(value) == "2147483648";
      const bool has_64_bits = std::string_view(name) == "paths" || std::string_view(name) == "request";
      if (fits && has_64_bits) continue;
      EXPECT_THAT(refusal(number_of(name), fmt::format("\"{}\": {}", name, value)), HasSubstr("is damaged"))
          << name << " " << value;
    }
  EXPECT_THAT(refusal(number_of("reach"), "\"reach\": 2147483647"), HasSubstr("is damaged"));
  for (const std::string name : {"mean", "square", "escaped", "absorbed"}) {
    const size_t at = bytes.find('"' + name + "\": [");
    const std::string first = bytes.substr(at, bytes.find(',', at) - at);
    EXPECT_EQ(refusal(first, first), "");
    EXPECT_THAT(refusal(first, '"' + name + "\": [1e30"), HasSubstr("is damaged"));
  }
  EXPECT_THAT(refusal(number_of("correlated_pixels"), "\"correlated_pixels\": 1e30"), HasSubstr("is damaged"));
}

/// A header can state any size; memory is allocated only for what the sums can contain.
TEST_F(Parts, ClaimsOfManyPixelsAreDamage) {
  const RenderPart small = part({0, 4});
  const FilmSettings& film = small.film.settings();
  std::string bytes = bytes_of(write(small, "a.part"));
  const std::string crop = fmt::format("\"crop\": [\n   {},\n   {},\n   {},\n   {}\n  ]", film.crop.x0, film.crop.y0,
                                       film.crop.x1, film.crop.y1);
  bytes = forged(bytes, crop, "\"crop\": [0, 0, 60000, 60000]");
  bytes = forged(bytes, fmt::format("\"width\": {}", film.width), "\"width\": 60000");
  bytes = forged(bytes, fmt::format("\"height\": {}", film.height), "\"height\": 60000");
  const fs::path path = folder_.write("f.part", bytes);
  EXPECT_THAT(error_of([&] { read_part(path); }), HasSubstr("is damaged"));
  EXPECT_THAT(error_of([&] { read_part_head(path); }), HasSubstr("is damaged"));
}

}  // namespace
}  // namespace frond
