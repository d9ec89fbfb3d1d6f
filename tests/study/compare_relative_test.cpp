#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "study/compare/error_unit.h"
#include "system/file_bytes.h"
#include "tests/study/compare_scene.h"
#include "tests/support/command_test.h"

namespace frond::compare {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Lit from above and seen from there, so that nothing is noisy: left a leaf, which fills half of the pixels, right a
/// floor that reflects 0.2.
constexpr std::string_view kHalves = R"(
LookAt 0 0 5  0 0 0  0 1 0
Camera "orthographic"
PixelFilter "box"
Film "rgb" "integer xresolution" 16 "integer yresolution" 8
Integrator "path" "integer maxdepth" 4
WorldBegin
LightSource "distant" "point3 from" [0 0 1] "point3 to" [0 0 0] "spectrum L" "stdillum-D65"
MakeNamedMaterial "blade" "string type" "leaf_simplified" "string specimen" "soybean"
NamedMaterial "blade"
Shape "trianglemesh" "integer indices" [0 1 2  0 2 3] "point3 P" [-9 -9 0  0 -9 0  0 9 0  -9 9 0]
Material "diffuse" "spectrum reflectance" [300 0.2  900 0.2]
Shape "trianglemesh" "integer indices" [0 1 2  0 2 3] "point3 P" [0 -9 0  9 -9 0  9 9 0  0 9 0]
)";

class CompareRelative : public CommandTest {
 protected:
  Outcome compare(const Words& more, std::string_view scene) const {
    return frond_command({"compare", folder_.write("scene.pbrt", scene).string(), "-o", path("report"), "--no-cache",
                          "--size", "16", "--spp", "2", "--reference-spp", "4"},
                         more);
  }
  /// A leaf that reflects so much at 551 and at 800 nm, evenly into all directions, and lets nothing through.
  std::string leaf(const std::string& name, double at_551, double at_800) const {
    const std::string rows = fmt::format("0,551,0,{},0\n0,800,0,{},0\n", at_551, at_800);
    return "leaf_simplified,tablefile=" + folder_.write(name, "theta_deg,wavelength_nm,Rs,Rd,T\n" + rows).string();
  }
  std::string file(const std::string& name) const { return read_file_bytes(path("report/" + name), {}); }
  nlohmann::json json() const { return nlohmann::json::parse(file("compare.json")); }
};

/// Exact but for the rounding of pixels: no figure here is random.
TEST_F(CompareRelative, ErrorsAreOverTheReferencesMeanOfTheSamePixelsAndBand) {
  const std::vector<std::string> halves{"--reference",   leaf("right.csv", 0.4, 0.32),
                                        "--materials",   leaf("wrong.csv", 0.44, 0.24),
                                        "--wavelengths", "bands,wavelengths=551,800"};
  auto relative = halves;
  relative.emplace_back("--relative");
  ASSERT_EQ(compare(halves, kHalves).code, 0);
  const auto absolute = json();
  const Outcome o = compare(relative, kHalves);
  ASSERT_EQ(o.code, 0) << o.err;
  const auto j = json();
  const auto error = [](const nlohmann::json& all, const std::string& region, const char* channel, const char* figure) {
    return double(row_of(all["comparison"], {{"samples", 2}, {"region", region}, {"channel", channel}})[figure]);
  };
  const std::map<std::string, std::array<double, 2>> expected{
      {"leaf", {0.04 / 0.4, 0.08 / 0.32}},
      // Half of the pixels are wrong, and the mean includes leaf and floor.
      {"all", {0.04 * std::sqrt(0.5) / 0.3, 0.08 * std::sqrt(0.5) / 0.26}}};
  for (const auto& [region, errors] : expected) {
    for (const char* figure : {"rms", "bias"}) {
      EXPECT_NEAR(error(j, region, "551 nm", figure), errors[0], 1e-5) << region;
      EXPECT_NEAR(error(j, region, "800 nm", figure), errors[1], 1e-5) << region;
    }
    const double together = std::hypot(errors[0], errors[1]) / std::sqrt(2);
    EXPECT_NEAR(error(j, region, "all bands", "bias"), together, 1e-5) << region;
    const double mean = row_of(j["reference"], {{"region", region}, {"channel", "800 nm"}})["mean"];
    EXPECT_NEAR(error(absolute, region, "800 nm", "bias") / mean, errors[1], 1e-5) << region;
  }
  EXPECT_EQ(j["reference_mean_unit"], "radiance over that of white");
  EXPECT_THAT(file("index.html"), HasSubstr("800 nm: 21.76 % (≤ "));
  EXPECT_THAT(file("bands.svg"), HasSubstr("% of the reference"));
}

TEST_F(CompareRelative, EveryOutputSaysSo) {
  const Outcome o =
      compare({"--materials", "abm,leaf_lambert", "--wavelengths", "smpte", "--rms", "0.9", "--relative"}, kLeafScene);
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(
      o.out,
      AllOf(HasSubstr("is enough for a relative RMS of 90 %, with 95 % confidence"), HasSubstr("Errors are relative: "),
            HasSubstr("Leaf by leaf, by frond render's pilot, this is enough for a relative RMS of 90 %")));
  EXPECT_THAT(o.err, AllOf(HasSubstr("its own noise RMS "), HasSubstr(" %, taken out below")));
  const auto j = json();
  EXPECT_THAT(std::string(j["unit"]), HasSubstr("mean of the reference"));
  EXPECT_THAT(std::string(j["notes"][0]), HasSubstr(" --relative"));
  EXPECT_EQ(j["meets_rms"][0]["rms"], 0.9);
  EXPECT_THAT(file("compare.csv"), HasSubstr("# Unit: mean of the reference over the same pixels"));
  EXPECT_THAT(file("rms.svg"), HasSubstr("% of the reference"));
  EXPECT_THAT(file("index.html"), AllOf(HasSubstr("A relative RMS of 90 %"), HasSubstr("Errors are relative: "),
                                        Not(HasSubstr("Table 2")), Not(HasSubstr("clipped"))));
}

TEST_F(CompareRelative, DoesNotGoWithATargetThatIsAbsolute) {
  EXPECT_THAT(compare({"--wavelengths", "smpte", "--target", "front", "--relative"}, kLeafScene).err,
              HasSubstr("--target excludes --relative"));
  EXPECT_FALSE(std::filesystem::exists(path("report")));
}

TEST_F(CompareRelative, NothingIsRelativeToBlack) {
  std::string scene(kLeafScene);
  scene.replace(scene.find("\"stdillum-D65\""), 14, "\"stdillum-D65\" \"float scale\" 0");
  EXPECT_THAT(compare({"--wavelengths", "smpte", "--materials", "abm", "--relative"}, scene).err,
              HasSubstr("the reference's mean in red over all pixels is 0: no error is relative to that"));
}

/// A leaf that nobody sees has no errors.
TEST_F(CompareRelative, NoLeafNeedsNoMean) {
  std::string scene(kLeafScene);
  scene.replace(scene.find("NamedMaterial \"blade\"\n"), 0, "Translate 0 -5 0\n");
  const Outcome o = compare({"--wavelengths", "smpte", "--materials", "abm", "--relative"}, scene);
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_TRUE(row_of(json()["reference"], {{"region", "leaf"}, {"channel", "red"}})["mean"].is_null());
}

TEST(RelativeErrors, AreReadInPerCent) {
  const ErrorUnit unit(true);
  EXPECT_EQ(unit.fixed(0.012345, 4), "1.23 %");
  EXPECT_EQ(unit.rounded(0.012345), "1.2 %");
  EXPECT_EQ(unit.rounded(3.456), "350 %");
  EXPECT_EQ(unit.in_argument_unit(0.07), "7 %");
  EXPECT_DOUBLE_EQ(unit.axis_value(0.02), 2);
}

}  // namespace
}  // namespace frond::compare
