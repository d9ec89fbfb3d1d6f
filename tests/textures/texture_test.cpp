#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "image/image_file.h"
#include "scene/registry.h"
#include "tests/support/bind.h"
#include "tests/support/input_error.h"
#include "tests/support/ramp.h"
#include "textures/mip_map.h"
#include "textures/noise.h"

namespace frond {

extern const FloatTextureInfo bilerp_float_texture, checkerboard_float_texture, dots_float_texture, fbm_float_texture,
    wrinkled_float_texture, image_float_texture;
extern const SpectrumTextureInfo image_spectrum_texture, soil_spectrum_texture;

namespace {

using test::make_plugin;
using test::number;

TextureMapping mapping_of(std::vector<ParsedParam> params, const Transform& world_from_texture = {}) {
  static constexpr std::span<const Param> kParams = kMappingParams;
  static constexpr PluginInfo kInfo{"test", "mapping", "", "", kParams};
  test::NoLookups none;
  return {Params(kInfo, {"mapping", {}, std::move(params)}, none), {world_from_texture}};
}

ParsedParam kind(const char* mapping) { return {"string", "mapping", {}, {}, std::vector<std::string>{mapping}}; }

/// The footprint's derivatives equal the differences of the coordinates from one point to the next.
void expect_changes_follow(const TextureMapping& mapping, const Vec3& p) {
  constexpr float kStep = 1e-3f;
  const Vec3 dx{kStep, 0, 0}, dy{0, kStep, -kStep};
  TexturePoint at{.uv = {}, .p = p};
  at.dp_dx = dx, at.dp_dy = dy;
  const TextureCoordinates place = mapping.at(at);
  const auto beside = [&](const Vec3& step) { return mapping.at({.uv = {}, .p = p + step}).st - place.st; };
  EXPECT_NEAR(place.dst_dx.x, beside(dx).x, 5e-6);
  EXPECT_NEAR(place.dst_dx.y, beside(dx).y, 5e-6);
  EXPECT_NEAR(place.dst_dy.x, beside(dy).x, 5e-6);
  EXPECT_NEAR(place.dst_dy.y, beside(dy).y, 5e-6);
}

TEST(TextureMapping, ScalesBeforeItShifts) {
  const auto mapping = mapping_of({number("float", "uscale", {2}), number("float", "udelta", {0.25}),
                                   number("float", "vscale", {-1}), number("float", "vdelta", {1})});
  TexturePoint at{.uv = {0.5f, 0.25f}};
  at.duv_dx = {0.1f, 0.2f};
  const TextureCoordinates place = mapping.at(at);
  EXPECT_EQ(place.st, (Vec2{1.25f, 0.75f}));
  EXPECT_EQ(place.dst_dx, (Vec2{0.2f, -0.2f}));
}

TEST(TextureMapping, OfPointsIsThatOfTheTexturesSpace) {
  const Transform moved = Transform::translate({1, 0, 0});
  const Vec3 p{1.3f, 0.4f, 0.5f}, in_texture{0.3f, 0.4f, 0.5f};
  const float phi = std::atan2(in_texture.y, in_texture.x), turn = float(2 * std::numbers::pi);
  const auto place = [&](const char* name) { return mapping_of({kind(name)}, moved).at({.uv = {}, .p = p}).st; };
  EXPECT_NEAR(place("planar").x, 0.3f, 1e-6);
  EXPECT_NEAR(place("planar").y, 0.4f, 1e-6);
  EXPECT_NEAR(place("cylindrical").x, 0.5f + phi / turn, 1e-6);
  EXPECT_NEAR(place("cylindrical").y, 0.5f, 1e-6);
  EXPECT_NEAR(place("spherical").x, std::acos(0.5f / length(in_texture)) / float(std::numbers::pi), 1e-6);
  EXPECT_NEAR(place("spherical").y, phi / turn, 1e-6);
  for (const char* name : {"planar", "cylindrical", "spherical"})
    expect_changes_follow(mapping_of({kind(name)}, moved), p);
}

TEST(TextureMapping, HasNumbersOnTheAxisToo) {
  for (const char* name : {"cylindrical", "spherical"}) {
    TexturePoint at{.uv = {}, .p = {0, 0, 0}};
    at.dp_dx = {1, 1, 1};
    const TextureCoordinates place = mapping_of({kind(name)}).at(at);
    for (const Vec2 v : {place.st, place.dst_dx}) EXPECT_TRUE(std::isfinite(v.x) && std::isfinite(v.y)) << name;
  }
}

Image ramp(int width, int height) {
  Image image(width, height, {"Y"});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y, 0) = float(x + 3 * y) / 64;
  return image;
}

constexpr MipMap::Filter kAllFilters[] = {MipMap::Filter::point, MipMap::Filter::bilinear, MipMap::Filter::trilinear,
                                          MipMap::Filter::ewa};

TEST(MipMap, KeepsAConstantAtEveryFootprint) {
  Image image(5, 3, {"Y"});
  for (float& v : image.pixels) v = 0.2f;
  for (const bool eight_bit : {true, false})
    for (const auto filter : kAllFilters)
      for (const auto wrap : {MipMap::Wrap::repeat, MipMap::Wrap::clamp, MipMap::Wrap::octahedral_sphere}) {
        const MipMap map(image, {}, eight_bit, {.filter = filter, .wrap = wrap});
        for (const float width : {0.f, 0.01f, 0.3f, 0.7f, 5.f, 1e30f})
          for (const float s : {-0.4f, 0.f, 0.37f, 1.f, 2.5f})
            EXPECT_NEAR(map.at({{s, 1 - s}, {width, 0}, {0, width / 3}})[0], 0.2f, 1e-6) << width << ' ' << s;
      }
}

TEST(MipMap, ItsTopIsTheMean) {
  for (const auto& [w, h] : {std::pair(8, 4), std::pair(7, 3), std::pair(1, 9), std::pair(1, 1)}) {
    const Image image = ramp(w, h);
    double mean = 0;
    for (const float v : image.pixels) mean += double(v) / double(image.pixels.size());
    for (const auto filter : kAllFilters) {
      const MipMap map(image, {}, false, {.filter = filter});
      EXPECT_NEAR(map.at({{0.3f, 0.6f}, {4, 0}, {0, 4}})[0], mean, 1e-6) << w << ' ' << h;
    }
  }
}

TEST(MipMap, ShowsTheFilesOwnTexelsWhateverTheirNumber) {
  const Image image = ramp(5, 3);
  const MipMap map(image, {}, false, {.filter = MipMap::Filter::point});
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x) {
      const Vec2 st{(float(x) + 0.5f) / 5, 1 - (float(y) + 0.5f) / 3};
      EXPECT_EQ(map.at({st, {}, {}})[0], image.at(x, y, 0));
    }
}

TEST(MipMap, EllipsesFollowARamp) {
  Image image(64, 64, {"Y"});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) image.at(x, y, 0) = (float(x) + 0.5f) / 64;
  const MipMap map(image, {}, false, {.filter = MipMap::Filter::ewa, .wrap = MipMap::Wrap::clamp});
  for (const float s : {0.4f, 0.5f, 0.613f})
    EXPECT_NEAR(map.at({{s, 0.5f}, {0.05f, 0.02f}, {0.01f, 0.03f}})[0], s, 2e-3);
}

TEST(MipMap, IsBlackBeyondABlackEdgeAndWhereThereIsNoPlace) {
  const MipMap map(ramp(4, 4), {}, false, {.filter = MipMap::Filter::bilinear, .wrap = MipMap::Wrap::black});
  EXPECT_EQ(map.at({{1.5f, 0.5f}, {}, {}})[0], 0);
  for (const auto wrap : {MipMap::Wrap::repeat, MipMap::Wrap::black, MipMap::Wrap::clamp}) {
    const MipMap other(ramp(4, 4), {}, false, {.wrap = wrap});
    EXPECT_EQ(other.at({{NAN, 0.5f}, {}, {}})[0], 0);
    EXPECT_TRUE(std::isfinite(other.at({{1e30f, -1e30f}, {NAN, 0}, {INFINITY, 0}})[0]));
  }
}

/// Resolver of file names only.
class FileLookup final : public ParamResolver {
 public:
  std::shared_ptr<const FloatTexture> float_texture(const std::string&, const Location& w) override { none(w); }
  std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string&, const Location& w) override { none(w); }
  std::shared_ptr<Material> material(const std::string&, const Location& w) override { none(w); }
  SpectrumPtr spectrum(const ParsedParam& p, SpectrumUse) override { none(p.where); }
  std::filesystem::path file(const std::string& name, const Location&) override { return name; }

 private:
  [[noreturn]] static void none(const Location& where) { fail(where, "this test resolves files alone"); }
};

TEST(ImageTexture, OneFileIsReadOnceForTexturesThatLookItUpAlike) {
  const TestFolder folder("shared_image");
  const std::string path = folder.name_of("a.exr");
  Image image(2, 2, {"R", "G", "B"});
  image.pixels.assign(12, 0.25f);
  write_image(path, image, {"linear sRGB", {}});
  FileLookup files;
  SharedWork shared;
  const auto make = [&](SharedWork* work, const char* wrap, double scale) {
    return image_float_texture.make(Params(image_float_texture,
                                           {"imagemap",
                                            {},
                                            {{"string", "filename", {}, {}, std::vector<std::string>{path}},
                                             {"string", "wrap", {}, {}, std::vector<std::string>{wrap}},
                                             number("float", "scale", {scale})}},
                                           files),
                                    {{}, work});
  };
  const auto first = make(&shared, "repeat", 1);
  std::filesystem::remove(path);
  EXPECT_EQ(make(&shared, "repeat", 2)->evaluate({.uv = {0.5f, 0.5f}}), 0.5f);
  EXPECT_EQ(first->evaluate({.uv = {0.5f, 0.5f}}), 0.25f);
  EXPECT_THROW(make(&shared, "clamp", 1), InputError);
  EXPECT_THROW(make(nullptr, "repeat", 1), InputError);
}

/// Returns an image's reflectance at 440, 545 and 620 nm.
SampledSpectrum colors_of(const std::string& path) {
  FileLookup files;
  const Params params(image_spectrum_texture,
                      {"imagemap", {}, {{"string", "filename", {}, {}, std::vector<std::string>{path}}}}, files);
  SampledWavelengths lambda;
  lambda.count = 3;
  lambda.nm = {440, 545, 620, 0};
  return image_spectrum_texture.make(params, {})->evaluate({.uv = {0.5f, 0.5f}}, lambda);
}

TEST(ImageTexture, ColoursAreInTheSpaceThatTheFileNames) {
  const TestFolder folder("image_space");
  const Triple rgb{0.5, 0.3, 0.2};
  const ColorSpace& wide = *find_color_space("rec2020");
  const Triple in_wide = wide.rgb_from_xyz * (find_color_space("srgb")->xyz_from_rgb * rgb);
  const auto write = [&](const char* name, const Triple& color, std::string_view space) {
    Image image(1, 1, {"R", "G", "B"});
    for (size_t c = 0; c < 3; ++c) image.pixels[c] = float(color[c]);
    write_image(folder.name_of(name), image, {std::string(space), {}});
    return folder.name_of(name);
  };
  const SampledSpectrum srgb = colors_of(write("srgb.exr", rgb, "linear sRGB"));
  const SampledSpectrum converted = colors_of(write("wide.exr", in_wide, wide.linear_name));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(converted[i], srgb[i], 1e-4);
}

TEST(Noise, IsZeroAtWholeNumbersAndBetweenMinusOneAndOne) {
  RandomStream random(1);
  for (int i = 0; i < 1000; ++i) {
    const auto whole = [&] { return std::floor(random.uniform() * 600) - 300; };
    EXPECT_EQ(perlin_noise({whole(), whole(), whole()}), 0);
    const Vec3 p{600 * random.uniform() - 300, 600 * random.uniform() - 300, 600 * random.uniform() - 300};
    EXPECT_LE(std::abs(perlin_noise(p)), 1);
    // Derivatives of gradient noise are at most some units.
    EXPECT_NEAR(perlin_noise(p), perlin_noise(p + Vec3{1e-3f, 0, 0}), 5e-3);
  }
}

float value(const FloatTextureInfo& info, std::vector<ParsedParam> params, const TexturePoint& at) {
  return make_plugin(info, std::move(params), TexturePlacement{})->evaluate(at);
}

TEST(Checkerboard, FirstIsWhereWholePartsHaveAnEvenSum) {
  for (const float u : {-1.5f, -0.5f, 0.5f, 1.5f, 1000.5f})
    for (const float v : {-0.5f, 0.5f, 1.5f}) {
      const bool even = std::fmod(std::floor(u) + std::floor(v), 2.f) == 0;
      EXPECT_EQ(value(checkerboard_float_texture, {}, {.uv = {u, v}}), even ? 1 : 0) << u << ' ' << v;
      const ParsedParam solid = number("integer", "dimension", {3});
      EXPECT_EQ(value(checkerboard_float_texture, {solid}, {.uv = {}, .p = {u, v, 2.5f}}), even ? 1 : 0);
    }
}

TEST(Checkerboard, IsTheTentsMeanOverTheFootprint) {
  // Over s alone: t lies well inside a square. The tent reaches 1.5 of the footprint to either side.
  for (const float step : {0.1f, 0.3f, 0.9f, 4.f})
    for (const float s : {0.02f, 0.45f, 0.97f, 1.3f}) {
      TexturePoint at{.uv = {s, 0.5f}};
      at.duv_dx = {step, 0};
      const double radius = 1.5 * double(step);
      double mean = 0;
      constexpr int kSteps = 100000;
      for (int i = 0; i < kSteps; ++i) {
        const double x = (2 * (i + 0.5) / kSteps - 1) * radius;
        const bool first = std::fmod(std::floor(double(s) + x) + 1000, 2) == 0;
        mean += (first ? 1 : 0) * (1 - std::abs(x) / radius) * 2 / kSteps;
      }
      EXPECT_NEAR(value(checkerboard_float_texture, {}, at), mean, 1e-3) << step << ' ' << s;
    }
}

TEST(Bilerp, MeetsItsCorners) {
  const std::vector<ParsedParam> params{number("float", "v00", {1}), number("float", "v01", {2}),
                                        number("float", "v10", {3}), number("float", "v11", {4})};
  EXPECT_EQ(value(bilerp_float_texture, params, {.uv = {0, 0}}), 1);
  EXPECT_EQ(value(bilerp_float_texture, params, {.uv = {0, 1}}), 2);
  EXPECT_EQ(value(bilerp_float_texture, params, {.uv = {1, 0}}), 3);
  EXPECT_EQ(value(bilerp_float_texture, params, {.uv = {1, 1}}), 4);
  EXPECT_EQ(value(bilerp_float_texture, params, {.uv = {0.5f, 0.5f}}), 2.5f);
}

TEST(NoiseTextures, HardlyComeNearTheirBounds) {
  EXPECT_FALSE(make_plugin(wrinkled_float_texture, {}, TexturePlacement{})->is_range_tight());
  EXPECT_TRUE(make_plugin(bilerp_float_texture, {}, TexturePlacement{})->is_range_tight());
}

TEST(NoiseTextures, StayInTheirRangesAndLoseWhatIsFinerThanTheFootprint) {
  RandomStream random(2);
  for (const FloatTextureInfo* info : {&fbm_float_texture, &wrinkled_float_texture}) {
    const auto texture = make_plugin(*info, {}, TexturePlacement{});
    for (int i = 0; i < 1000; ++i) {
      TexturePoint at{.uv = {}, .p = {9 * random.uniform(), 9 * random.uniform(), 9 * random.uniform()}};
      at.dp_dx = {random.uniform() * 0.2f, 0, 0};
      EXPECT_TRUE(texture->range().contains(double(texture->evaluate(at))));
    }
  }
  TexturePoint coarse{.uv = {}, .p = {0.3f, 0.6f, 0.9f}};
  coarse.dp_dx = {10, 0, 0};
  EXPECT_EQ(value(fbm_float_texture, {}, coarse), 0);
  // The mean of all eight octaves, and of the first once more: so it is in pbrt-v4.
  EXPECT_NEAR(value(wrinkled_float_texture, {}, coarse), 0.2 * (3 - std::pow(0.5, 7)), 1e-5);
}

TEST(SoilTexture, IsDarkerWhereItIsWet) {
  const SampledWavelengths lambda{
      .nm = {450, 670, 860, 1650}, .pdf = {1, 1, 1, 1}, .active = {true, true, true, true}, .count = 4};
  const auto soil = [&](std::vector<ParsedParam> params) {
    return make_plugin(soil_spectrum_texture, std::move(params), TexturePlacement{})->evaluate({}, lambda);
  };
  const auto word = [](const char* name) {
    return ParsedParam{"string", "soil", {}, {}, std::vector<std::string>{name}};
  };
  const SampledSpectrum dry = soil({}), damp = soil({number("float", "moisture", {20})}),
                        wet = soil({number("float", "moisture", {50})});
  for (int i = 0; i < 4; ++i) {
    EXPECT_GT(dry[i], damp[i]);
    EXPECT_GT(damp[i], wet[i]);
  }
  const std::vector<double> clay{0.459, 0.011, -0.009, 0.038};
  EXPECT_EQ(soil({number("float", "coefficients", clay)})[1], dry[1]) << "dry_clay is the default";
  EXPECT_NE(error_of([&] {
              soil({word("dry_sand"), number("float", "coefficients", clay)});
            }).find("exclude each other"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              soil({number("float", "coefficients", {1, 2})});
            }).find("needs 4 values"),
            std::string::npos);
  EXPECT_NE(error_of([&] { soil({word("mud")}); }).find("dry_clay"), std::string::npos);
  EXPECT_NE(error_of([&] { soil({number("float", "moisture", {60})}); }).find("55"), std::string::npos);
}

}  // namespace
}  // namespace frond
