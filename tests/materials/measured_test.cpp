#include <gmock/gmock.h>

#include <cstring>
#include <fstream>

#include "materials/lobes/trowbridge_reitz.h"
#include "system/file_bytes.h"
#include "tests/materials/support.h"
#include "tests/support/input_error.h"

/// Material "measured" with tensor files: of metals by a formula, which tests/pbrt_reference/measured_tensors.py
/// writes.
namespace frond::test {
namespace {

using ::testing::HasSubstr;

constexpr float kDegree = kPi / 180;
const std::string kFolder = FROND_SOURCE_DIR "/tests/pbrt_reference/";

Vec3 direction(Vec2 degrees) {
  const float theta = degrees.x * kDegree, phi = degrees.y * kDegree;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

SampledSpectrum f_of(Ready& ready, const Vec3& wo, const Vec3& wi) {
  RandomStream rng(1);
  return ready.bsdf().f(wo, wi, rng);
}

/// f and pdf at 608, 551 and 455 nm as Mitsuba 3.9.1 (`measured`, llvm_ad_spectral) returns them.
struct Peer {
  const char* file;
  Vec2 wo, wi;  ///< theta and phi, degrees
  std::array<float, 3> f;
  float pdf;
};
constexpr Peer kMitsuba[] = {
    {"metal", {20, 0}, {35, 170}, {0.304387f, 0.342352f, 0.406293f}, 0.54914f},
    {"metal", {50, -70}, {40, 100}, {0.46669f, 0.524898f, 0.622934f}, 0.809653f},
    {"metal", {65, 30}, {10, -120}, {0.125623f, 0.141292f, 0.167681f}, 0.28257f},
    {"metal", {80, 120}, {70, -40}, {0.332875f, 0.374394f, 0.44432f}, 0.247726f},
    {"brushed", {20, 0}, {35, 170}, {0.312552f, 0.351536f, 0.417192f}, 0.548918f},
    {"brushed", {50, -70}, {40, 100}, {0.513694f, 0.577766f, 0.685675f}, 0.854279f},
    {"brushed", {65, 30}, {10, -120}, {0.0290903f, 0.0327187f, 0.0388295f}, 0.0625237f},
    {"brushed", {80, 120}, {70, -40}, {0.0932058f, 0.104831f, 0.12441f}, 0.0660168f},
};

TEST(Measured, IsWhatMitsubaReads) {
  for (const auto& [file, o, i, f, pdf] : kMitsuba) {
    Ready ready("measured", {words("filename", {kFolder + file + ".bsdf"})});
    const Vec3 wo = direction(o), wi = direction(i);
    const SampledSpectrum found = f_of(ready, wo, wi);
    for (int lane = 0; lane < 3; ++lane) EXPECT_NEAR(found[lane], f[size_t(lane)], 2e-4f * f[size_t(lane)]) << file;
    EXPECT_NEAR(ready.bsdf().pdf(wo, wi), pdf, 2e-4f * pdf) << file;
    EXPECT_FLOAT_EQ(f_of(ready, -wo, -wi)[0], found[0]) << "the same on both sides";
    EXPECT_TRUE(f_of(ready, wo, -wi).is_black());
  }
}

/// RMS of the error of f cos over the hemisphere of wi, relative to the RMS of the formula's.
double error_of_formula(const char* file, const TrowbridgeReitz& facets, const Vec3& wo) {
  Ready ready("measured", {words("filename", {kFolder + file + ".bsdf"})});
  RandomStream rng(1);
  double error = 0, size = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vec3 wi = sample_cosine_hemisphere({rng.uniform(), rng.uniform()}), m = normalize(wo + wi);
    const float f = facets.density(m) * facets.g1_over_cosine(wo) * facets.g1_over_cosine(wi) / 4;  // Smith's G1 apart
    const float reflectance = 0.9f - 0.6f * (608 - 360) / 470, truth = reflectance * f, found = f_of(ready, wo, wi)[0];
    error += double(found - truth) * double(found - truth) * double(wi.z);
    size += double(truth) * double(truth) * double(wi.z);
  }
  return std::sqrt(error / size);
}

// The remaining errors are caused by the small grids of the files.
TEST(Measured, IsTheFormula) {
  EXPECT_LT(error_of_formula("metal", {0.4f, 0.4f}, direction({30, 40})), 0.015);
  EXPECT_LT(error_of_formula("metal", {0.4f, 0.4f}, direction({60, -100})), 0.025);
  EXPECT_LT(error_of_formula("brushed", {0.2f, 0.5f}, direction({30, 45})), 0.04);
  EXPECT_LT(error_of_formula("brushed", {0.2f, 0.5f}, direction({60, -90})), 0.07);
}

/// Error for a changed tensor file.
std::string error_of_bytes(const std::string& bytes) {
  const std::string path = ::testing::TempDir() + "frond_changed.bsdf";
  std::ofstream(path, std::ios::binary) << bytes;
  return error_of([&] { Ready("measured", {words("filename", {path})}); });
}

TEST(Measured, RefusesFilesThatAreTruncated) {
  const std::string whole = read_file_bytes(kFolder + "metal.bsdf", {});
  ASSERT_EQ(error_of_bytes(whole), "");
  for (const size_t kept : {size_t{12}, size_t{17}, size_t{40}, size_t{300}})
    EXPECT_THAT(error_of_bytes(whole.substr(0, kept)), HasSubstr("truncated"));
  EXPECT_THAT(error_of_bytes(whole.substr(0, whole.size() - 1)), HasSubstr("truncated: field \"spectra\""));
}

TEST(Measured, RefusesFieldsThatDoNotFit) {
  const std::string whole = read_file_bytes(kFolder + "metal.bsdf", {});
  const auto changed = [&whole](std::string_view name, size_t beyond, auto number) {
    std::string bytes = whole;
    std::memcpy(bytes.data() + whole.find(name) + name.size() + beyond, &number, sizeof number);
    return error_of_bytes(bytes);
  };
  constexpr size_t kType = 2, kOffset = 3, kShape = 11;
  EXPECT_THAT(changed("ndf", kShape, uint64_t{1} << 62), HasSubstr("field \"ndf\" ends after"));
  EXPECT_THAT(changed("ndf", kOffset, ~uint64_t{0}), HasSubstr("field \"ndf\" ends after"));
  EXPECT_THAT(changed("ndf", kType, uint8_t{99}), HasSubstr("unknown type 99"));
  EXPECT_THAT(changed("ndf", kType, uint8_t{5}), HasSubstr("needs 32-bit floats"));
  EXPECT_THAT(changed("ndf", kShape, uint64_t{1}), HasSubstr("2 x 2 values or more"));
  EXPECT_THAT(changed("theta_i", kShape, uint64_t{9}), HasSubstr("does not fit phi_i, theta_i"));
  EXPECT_THAT(changed("wavelengths", kShape, uint64_t{0}), HasSubstr("\"wavelengths\" is empty"));
  EXPECT_THAT(changed("sigm", 0, 'x'), HasSubstr("no field \"sigma\""));
  EXPECT_THAT(changed("tensor_file", 1, uint8_t{2}), HasSubstr("version 2.0"));
}

TEST(Measured, RefusesNumbersThatNoBrdfHas) {
  std::string bytes = read_file_bytes(kFolder + "metal.bsdf", {});
  const float none = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + bytes.size() - sizeof none, &none, sizeof none);
  EXPECT_THAT(error_of_bytes(bytes), HasSubstr("\"spectra\" contains nan"));
}

TEST(Measured, RefusesColours) {
  std::string bytes = read_file_bytes(kFolder + "metal.bsdf", {});
  bytes.replace(bytes.find("spectra"), 7, "Spectra").replace(bytes.find("ndf"), 3, "rgb");
  EXPECT_THAT(error_of_bytes(bytes), HasSubstr("colours instead of spectra"));
}

TEST(Measured, RefusesWavelengthsBeyondItsData) {
  std::string bytes = read_file_bytes(kFolder + "metal.bsdf", {});
  const std::array<float, 3> nm{360, 595, 830}, fewer{500, 595, 830};
  const auto text = [](const std::array<float, 3>& numbers) {
    return std::string_view(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
  };
  bytes.replace(bytes.find(text(nm)), sizeof nm, text(fewer));
  EXPECT_THAT(error_of_bytes(bytes), HasSubstr("\"filename\" is known from 500 to 830 nm"));
  EXPECT_THAT(error_of([] { Ready("measured", {}); }), HasSubstr("needs parameter \"string filename\""));
}

}  // namespace
}  // namespace frond::test
