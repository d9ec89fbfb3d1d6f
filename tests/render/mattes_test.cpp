// Channels alpha, CryptoObject and CryptoMaterial, and the range of albedo.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "render/film/cryptomatte.h"
#include "render/parts/part_file.h"
#include "tests/render/render_scene.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using test::SceneRender;

/// Black disks before a sky of radiance 1: two instances of "leaf" in "plant", and one shape outside of objects.
constexpr const char* kDisks = R"(
Scale -1 1 1
LookAt 0 0 1  0 0 0  0 1 0
Camera "orthographic"
Film "rgb" "integer xresolution" 40 "integer yresolution" 27
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
MakeNamedMaterial "blade" "string type" "diffuse" "rgb reflectance" [ 0 0 0 ]
ObjectBegin "leaf"
  NamedMaterial "blade"
  Shape "disk" "float radius" 0.3
ObjectEnd
ObjectBegin "plant"
  Translate -0.5 0 0
  ObjectInstance "leaf"
  Translate 0.4 0.1 -0.1
  ObjectInstance "leaf"
ObjectEnd
ObjectInstance "plant"
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
Translate 0.6 0 0
Shape "disk" "float radius" 0.4
)";

class Mattes : public ::testing::Test {
 protected:
  void SetUp() override { scene_ = folder_.write("scene.pbrt", kDisks); }
  RenderPart part(SceneRender how = {}) const {
    how.channels = {"alpha", "CryptoObject", "CryptoMaterial"};
    return how.part(scene_, {0, 9});
  }
  static float value(const Image& image, int x, int y, const std::string& name) {
    return image.at(x, y, image.channel(name).value());
  }
  /// Coverage of a name in a pixel, from the channels of a layer, as a compositor finds it.
  static double coverage(const Image& image, int x, int y, const std::string& layer, const std::string& name) {
    double sum = 0;
    for (const char* pair : {"00.R 00.G", "00.B 00.A", "01.R 01.G", "01.B 01.A", "02.R 02.G", "02.B 02.A"}) {
      const std::string text = pair;
      if (std::bit_cast<uint32_t>(value(image, x, y, layer + text.substr(0, 4))) ==
          std::bit_cast<uint32_t>(matte_id(name)))
        sum += double(value(image, x, y, layer + text.substr(5)));
    }
    return sum;
  }
  TestFolder folder_{"mattes"};
  std::filesystem::path scene_;
};

/// Values of Appleby's program for seed 0; "bunny" and "default" are in the manifest of Psyop's sample image.
TEST(Cryptomatte, HashIsThePublicOne) {
  EXPECT_EQ(murmur3(""), 0u);
  EXPECT_EQ(murmur3("hello"), 0x248bfa47u);
  EXPECT_EQ(murmur3("hello, world"), 0x149bbb7fu);
  EXPECT_EQ(murmur3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
  EXPECT_EQ(murmur3("bunny"), 0x13851a76u);
  EXPECT_EQ(murmur3("default"), 0x42c9679fu);
  EXPECT_TRUE(std::isnormal(matte_id("")));  // 0 would be denormal
}

/// Light reaches the film only beside the disks: their coverage equals the missing share of the colours, weight by
/// weight.
TEST_F(Mattes, AlphaHasTheFilterOfTheColors) {
  for (const char* filter : {"gaussian", "gaussian,reconstruction=importance", "box", "triangle,xradius=1.3"}) {
    const RenderPart rendered = part({.wavelengths = "smpte", .filter = filter});
    const Image image = film_image(rendered.film, finished_format(rendered));
    const Image plain = [&] {
      const RenderPart other = SceneRender{.wavelengths = "smpte", .filter = filter}.part(scene_, {0, 9});
      return film_image(other.film, other.header.image);
    }();
    const double white = double(value(image, 0, 0, "G"));
    int edges = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const double a = double(value(image, x, y, "A"));
        EXPECT_NEAR(double(value(image, x, y, "G")) / white, 1 - a, 2e-5) << filter << ' ' << x << ' ' << y;
        edges += a > 0.01 && a < 0.99 ? 1 : 0;
        for (const char* c : {"R", "G", "B", "variance.G", "leaf"})
          EXPECT_EQ(value(image, x, y, c), value(plain, x, y, c)) << "the colours do not change";
      }
    EXPECT_GT(edges, 40) << filter;
  }
}

TEST_F(Mattes, OfABandAreThoseOfColors) {
  const RenderPart colors = part(), bands = part({.wavelengths = "bands,wavelengths=550,650"});
  for (int x = 0; x < 40; ++x) {
    const auto a = colors.film.mattes(x, 13, 0), b = bands.film.mattes(x, 13, 0);
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].coverage, b[i].coverage);
  }
}

TEST_F(Mattes, DecodeByName) {
  const RenderPart rendered = part();
  const ImageFormat format = finished_format(rendered);
  const Image image = film_image(rendered.film, format);
  EXPECT_EQ(coverage(image, 12, 13, "CryptoObject", "leaf.1"), 1);
  EXPECT_EQ(coverage(image, 19, 11, "CryptoObject", "leaf.2"), 1);
  EXPECT_EQ(coverage(image, 30, 13, "CryptoObject", "diffuse.3"), 1)
      << "a shape outside objects has its material's name";
  EXPECT_EQ(coverage(image, 12, 13, "CryptoMaterial", "blade"), 1);
  EXPECT_EQ(coverage(image, 30, 13, "CryptoMaterial", "diffuse.3"), 1);
  double mixed = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double a = coverage(image, x, y, "CryptoObject", "leaf.1"),
                   b = coverage(image, x, y, "CryptoObject", "leaf.2"),
                   c = coverage(image, x, y, "CryptoObject", "diffuse.3");
      EXPECT_NEAR(a + b + c, double(value(image, x, y, "A")), 1e-6);
      EXPECT_NEAR(a + b, coverage(image, x, y, "CryptoMaterial", "blade"), 1e-6);
      mixed += std::min(a, b);
    }
  EXPECT_GT(mixed, 1) << "no pixel has an edge of both leaves";
  const std::string key = fmt::format("cryptomatte/{:.7}/", fmt::format("{:08x}", murmur3("CryptoObject")));
  EXPECT_EQ(format.attributes.at(key + "name"), "CryptoObject");
  EXPECT_EQ(format.attributes.at(key + "hash"), "MurmurHash3_32");
  EXPECT_EQ(format.attributes.at(key + "conversion"), "uint32_to_float32");
  const auto manifest = nlohmann::json::parse(format.attributes.at(key + "manifest"));
  EXPECT_EQ(manifest.size(), 3u);
  for (const char* name : {"leaf.1", "leaf.2", "diffuse.3"})
    EXPECT_EQ(manifest.at(name), fmt::format("{:08x}", std::bit_cast<uint32_t>(matte_id(name))));
}

TEST_F(Mattes, OfPartsAndCropsAreThoseOfTheWhole) {
  for (const char* filter : {"gaussian", "box"}) {
    const RenderPart whole = part({.filter = filter});
    std::vector<std::filesystem::path> files;
    for (const Crop& pixels : {Crop{0, 0, 17, 27}, {17, 0, 40, 14}, {17, 14, 40, 27}}) {
      const RenderPart piece = part({.pixels = pixels, .filter = filter});
      files.push_back(folder_.name_of(fmt::format("{}.part", files.size())));
      write_part(files.back(), piece.header, piece.film);
      EXPECT_EQ(read_part(files.back()).film, piece.film);
    }
    const RenderPart merged = merge_parts(files),
                     crop = part({.pixels = Crop{9, 7, 22, 20}, .is_part = false, .filter = filter});
    EXPECT_EQ(merged.film, whole.film) << filter;
    const Image all = film_image(whole.film, finished_format(whole)),
                of_parts = film_image(merged.film, finished_format(merged)),
                of_crop = film_image(crop.film, finished_format(crop));
    EXPECT_EQ(of_parts.pixels, all.pixels) << filter;
    EXPECT_EQ(finished_format(merged).attributes, finished_format(whole).attributes);
    for (const char* name : {"A", "CryptoObject00.G", "CryptoMaterial00.R"})
      EXPECT_EQ(value(of_crop, 2, 3, name), value(all, 11, 10, name)) << filter << ' ' << name;
  }
}

/// The disks are black: without the sky nothing is left.
TEST_F(Mattes, AHiddenBackgroundIsBlack) {
  for (const char* integrator : {"path,hidebackground=true", "volpath,hidebackground=true"}) {
    const RenderPart rendered = part({.integrator = integrator});
    for (int x = 0; x < 40; ++x) EXPECT_EQ(rendered.film.mean(x, 13), Triple{}) << integrator;
    EXPECT_GT(rendered.film.mattes(30, 13, 0).at(0).coverage, 0.99) << integrator;
  }
}

/// It lights the disk all the same: white, with all of the sky's light.
TEST_F(Mattes, AHiddenBackgroundLights) {
  std::string text = kDisks;
  text.replace(text.rfind("[ 0 0 0 ]"), 9, "[ 1 1 1 ]");
  const auto scene = folder_.write("white.pbrt", text);
  for (const char* kind : {"path,lightsamples=1,scatteredrays=1", "volpath"}) {
    const RenderPart seen = SceneRender{.integrator = kind}.part(scene, {0, 16}),
                     hidden =
                         SceneRender{.integrator = std::string(kind) + ",hidebackground=true"}.part(scene, {0, 16});
    EXPECT_EQ(hidden.film.mean(30, 13), seen.film.mean(30, 13)) << kind;
    EXPECT_GT(hidden.film.mean(30, 13)[1], 0.5) << kind;
    EXPECT_EQ(hidden.film.mean(0, 0)[1], 0) << kind;
  }
}

/// Four wavelengths of a sample have a colour outside the space of R, G and B; so do samples of a saturated surface.
TEST(AlbedoChannel, LiesBetween0And1) {
  const TestFolder folder("albedo");
  std::string text = test::a_scene();
  text.replace(text.find("[.2 .5 .1]"), 10, "[ 0 .99 0]");
  const RenderPart part = SceneRender{.channels = {"albedo", "Albedo"}}.part(folder.write("scene.pbrt", text), {0, 1});
  const Image image = film_image(part.film, part.header.image);
  int outside = 0, inside = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (const char* name : {"albedo.R", "albedo.G", "albedo.B", "Albedo.R", "Albedo.G", "Albedo.B"}) {
        const float v = image.at(x, y, image.channel(name).value());
        EXPECT_TRUE(v >= 0 && v <= 1) << name << ' ' << v;
        inside += v > 0 && v < 1 ? 1 : 0;
      }
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (size_t c = 0; c < 3; ++c) outside += part.film.features(x, y).means[c] < 0 ? 1 : 0;
  EXPECT_GT(outside, 20) << "the film's own means show no such colour: the test needs another scene";
  EXPECT_GT(inside, 500);
}

}  // namespace
}  // namespace frond
