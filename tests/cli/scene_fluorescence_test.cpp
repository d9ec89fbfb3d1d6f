#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "image/image_file.h"
#include "tests/cli/table.h"
#include "tests/support/command_test.h"

/// `frond brf --fluorescence` and `frond flux --fluorescence`; tests/radiometry tests what they measure.
namespace frond {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class SceneFluorescenceJobs : public CommandTest {
 protected:
  Outcome measured(const std::string& light, std::vector<std::string> words) {
    const auto scene = folder_.write(
        "scene.pbrt",
        "Option \"float period\" [2 2]\nWorldBegin\n" + light +
            "Material \"leaf_solved\" \"float fluorescence\" 0.01 \"float tolerance\" 0.05\n"
            "ObjectBegin \"leaf\" Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] ObjectEnd\n"
            "ObjectInstance \"leaf\" Translate 1 1 1 ObjectInstance \"leaf\"\n");
    words.insert(words.begin() + 1, {scene.string(), "--fluorescence", "--no-cache"});
    return frond_command(words);
  }
};

constexpr const char* kClearSky = "LightSource \"sky\" \"float elevation\" 60\n";
constexpr const char* kLowSun =
    "LightSource \"distant\" \"point3 from\" [-1 0 2] \"point3 to\" [0 0 0] \"spectrum L\" \"stdillum-E\"\n";

TEST_F(SceneFluorescenceJobs, BrfWritesRadiancesAndEscapeFractions) {
  const Outcome o = measured(kClearSky, {"brf", "--zenith", "0,40", "--emission", "685,740", "--paths", "256", "--csv",
                                         "-", "--json", path("f.json")});
  ASSERT_EQ(o.code, 0) << o.err;
  const CsvTable csv = parse_csv(o.out);
  EXPECT_EQ(csv.names,
            (std::vector<std::string>{"zenith_deg", "azimuth_deg", "wavelength_nm", "radiance", "radiance_se",
                                      "photon_radiance", "photon_radiance_se", "escape", "escape_se"}));
  ASSERT_EQ(csv.rows.size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    // 1 mW at 740 nm is 6.186 nmol/s of photons.
    EXPECT_NEAR(csv.number(i, "photon_radiance") / csv.number(i, "radiance"),
                6.186 * csv.number(i, "wavelength_nm") / 740, 2e-3);
    EXPECT_GT(csv.number(i, "radiance"), 10 * csv.number(i, "radiance_se"));
    EXPECT_GT(csv.number(i, "escape"), 0.2);
    EXPECT_LT(csv.number(i, "escape"), 1);
  }
  EXPECT_THAT(o.out, HasSubstr("# emission: Gaussians at 688 and 746 nm"));
  EXPECT_THAT(o.err, Not(HasSubstr("units of the scene's light")));
  const auto json = nlohmann::json::parse(bytes_of(path("f.json")));
  EXPECT_EQ(json["quantity"], "fluorescence");
  EXPECT_EQ(json["escape"].size(), 2u);
  EXPECT_THAT(measured(kLowSun, {"brf", "--zenith", "0", "--paths", "64"}).err,
              HasSubstr("units of the scene's light"));
}

TEST_F(SceneFluorescenceJobs, FluxCountsPhotonsByLeaf) {
  const Outcome o = measured(kClearSky, {"flux", "--by", "instance", "--emission", "740", "--paths", "4096", "--csv",
                                         path("leaves.csv"), "--json", path("f.json")});
  ASSERT_EQ(o.code, 0) << o.err;
  const CsvTable leaves = parse_csv(bytes_of(path("leaves.csv")));
  ASSERT_EQ(leaves.rows.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_GT(leaves.number(i, "excited_umol_m2_s"), 100);
    EXPECT_GT(leaves.number(i, "emitted_740"), leaves.number(i, "left_740"));
  }
  const CsvTable balance = parse_csv(bytes_of(path("leaves-fluorescence.csv")));
  EXPECT_THAT(balance.names, ::testing::Contains("photon_flux_se"));
  const auto json = nlohmann::json::parse(bytes_of(path("f.json")));
  EXPECT_GT(json["incident_umol_m2_s"], 1000);
  EXPECT_EQ(json["fluorescence"][0]["quantity"], "excited");
}

/// Bands of fluorescence beside those of reflected light, from one run and from parts.
TEST_F(SceneFluorescenceJobs, ImagesAndPartsHaveItsBands) {
  setenv("SOURCE_DATE_EPOCH", "0", 1);
  folder_.write(
      "matrices.csv",
      "excitation_nm,emission_nm,Mb,Mf\n400,640,1e-5,1e-5\n400,850,1e-5,1e-5\n750,640,1e-5,1e-5\n750,850,1e-5,1e-5\n");
  folder_.write("shares.csv", "theta_deg,wavelength_nm,Rs,Rd,T\n8,400,0,0.1,0.1\n8,850,0,0.4,0.4\n");
  folder_.write("image.pbrt",
                "LookAt 0 0 1  0 0 0  0 1 0\nCamera \"orthographic\"\n"
                "Film \"rgb\" \"integer xresolution\" 6 \"integer yresolution\" 4\nWorldBegin\n" +
                    std::string(kClearSky) +
                    "Material \"leaf_lambert\" \"string tablefile\" \"shares.csv\" \"string fluorescencematrices\" "
                    "\"matrices.csv\"\nShape \"disk\" \"float radius\" 9\n");
  const auto run = [&](const Words& more) {
    const Outcome o = frond_command({"render", path("image.pbrt"), "--no-cache", "-q", "--wavelengths",
                                     "bands,wavelengths=550,740,fluorescence=740,685"},
                                    more);
    EXPECT_EQ(o.code, 0) << o.err;
  };
  run({"--spp", "16", "-o", path("single.exr")});
  run({"--samples", "0:5", "--part", path("a.part")});
  run({"--samples", "5:16", "--part", path("b.part")});
  const Outcome merged = frond_command({"merge", path("a.part"), path("b.part"), "-o", path("merged.exr"), "-q"});
  ASSERT_EQ(merged.code, 0) << merged.err;
  const ImageFile single = read_image(path("single.exr"), {}), whole = read_image(path("merged.exr"), {});
  EXPECT_EQ(single.image.pixels, whole.image.pixels);
  for (const char* name : {"S0.550,000000nm", "S0.740,000000nm", "S0.F740", "S0.F685"}) {
    const auto channel = single.image.channel(name);
    ASSERT_TRUE(channel) << name;
    EXPECT_GT(single.image.pixels[*channel], 0) << name;
  }
}

/// No emission at 640 nm: its error does not count.
TEST_F(SceneFluorescenceJobs, RefinesAlsoWhereNothingIsEmitted) {
  const Outcome o = measured(kClearSky, {"brf", "--zenith", "0", "--emission", "640,740", "--rms", "0.02", "--csv", "-",
                                         "--plot", path("f.svg")});
  ASSERT_EQ(o.code, 0) << o.err;
  const CsvTable csv = parse_csv(o.out);
  EXPECT_EQ(csv.rows.size(), 2u);
  EXPECT_LT(csv.number(1, "radiance_se"), 0.025 * csv.number(1, "radiance"));
  EXPECT_THAT(bytes_of(path("f.svg")), HasSubstr("radiance"));
}

TEST_F(SceneFluorescenceJobs, SaysWhatIsMissing) {
  EXPECT_THAT(measured(kClearSky, {"flux", "--emission", "600"}).err, HasSubstr("from 640 to 850"));
  EXPECT_THAT(measured(kClearSky, {"brf", "--wavelengths", "740"}).err, HasSubstr("--wavelengths"));
}

}  // namespace
}  // namespace frond
