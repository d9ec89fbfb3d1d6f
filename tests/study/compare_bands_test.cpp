#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/log.h"
#include "spectra/cie.h"
#include "study/compare/channels.h"
#include "study/compare/study.h"
#include "system/file_bytes.h"
#include "tests/study/compare_scene.h"
#include "tests/support/command_test.h"

namespace frond::compare {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class CompareBands : public CommandTest {
 protected:
  ChannelList channels(const std::string& wavelengths, std::string_view scene = kLeafScene) const {
    const Log& quiet = silent_log();
    Session session(quiet, {.threads = 1});
    const Study study(session,
                      {.scene = folder_.write("scene.pbrt", scene).string(), .wavelengths = wavelengths, .size = 8});
    return channels_of(*study.scene(parse_candidate("leaf_lambert")));
  }
  Outcome compare(const Words& more) const {
    return frond_command(
        {"compare", folder_.write("scene.pbrt", kLeafScene).string(), "-o", path("report"), "--no-cache", "--size",
         "16", "--spp", "4", "--reference-spp", "8", "--materials", "abm,leaf_lambert"},
        more);
  }
  std::string file(const std::string& name) const { return read_file_bytes(path("report/" + name), {}); }
};

TEST_F(CompareBands, CountInWhitesOfTheScenesLight) {
  const ChannelList list = channels("bands,wavelengths=450,551,700");
  EXPECT_THAT(list.names, ElementsAre("all bands", "450 nm", "551 nm", "700 nm"));
  for (size_t b = 0; b < 3; ++b) EXPECT_NEAR(list.white[b], double(unit_d65()->at(float(list.bands[b].nm))), 1e-8);
}

/// Half the power of each: L of equal energy lies at 1 / 106.856895 everywhere.
TEST_F(CompareBands, MixTheLightsByTheirPower) {
  std::string scene(kLeafScene);
  scene.replace(scene.find("MakeNamed"), 0, "LightSource \"infinite\" \"spectrum L\" [300 1 2500 1]\n");
  const ChannelList list = channels("bands,wavelengths=450,551", scene);
  for (size_t b = 0; b < 2; ++b)
    EXPECT_NEAR(list.white[b], (double(unit_d65()->at(float(list.bands[b].nm))) + 1 / 106.856895) / 2, 1e-7);
}

TEST_F(CompareBands, AResponseCountsItsMeanWhite) {
  folder_.write("flat.spd", "500 1  600 1");
  double mean = 0;
  for (int i = 0; i < 1000; ++i) mean += double(unit_d65()->at(500.05f + 0.1f * float(i))) / 1000;
  EXPECT_NEAR(channels("bands,responses=" + path("flat.spd")).white[0], mean, 1e-3 * mean);
}

/// Two nanometres of a table that is 0 elsewhere.
TEST_F(CompareBands, ANarrowResponseCountsItsOwnWhite) {
  folder_.write("narrow.spd", "400 0  563.1 0  564.1 1  565.1 0  800 0");
  const double d65 = double(unit_d65()->at(564.1f));  // linear around it
  EXPECT_NEAR(channels("bands,responses=" + path("narrow.spd")).white[0], d65, 1e-6 * d65);
}

TEST_F(CompareBands, AreSeenAsColoursOrThreeOfThemAsFalseOnes) {
  EXPECT_THAT(channels("bands,step=50").how_shown, HasSubstr("linear interpolation"));
  const ChannelList list = channels("bands,wavelengths=700,750,800");
  EXPECT_THAT(list.how_shown, HasSubstr("800 nm as red, 750 nm as green, 700 nm as blue"));
  EXPECT_THAT(list.shown, ElementsAre(Triple{0, 0, 1}, Triple{0, 1, 0}, Triple{1, 0, 0}));
}

/// A white surface is white: bands at every 5 nm leave an error of their sum alone.
TEST_F(CompareBands, WhiteIsShownWhite) {
  const ChannelList list = channels("bands,lambdamin=360,lambdamax=830,step=5");
  Triple sum{};
  for (const Triple& share : list.shown)
    for (size_t c = 0; c < 3; ++c) sum[c] += share[c];
  for (const double v : sum) EXPECT_NEAR(v, 1, 0.003);
}

TEST_F(CompareBands, OnlyTheSameOnesAreAlike) {
  folder_.write("a.spd", "500 1  600 1");
  folder_.write("b.spd", "500 1  550 0.5  600 1");  // the same centre
  const auto of = [&](const char* name) { return channels("bands,responses=" + path(name)); };
  EXPECT_TRUE(same_channels(of("a.spd"), of("a.spd")));
  EXPECT_FALSE(same_channels(of("a.spd"), of("b.spd")));
  EXPECT_FALSE(same_channels(of("a.spd"), channels("bands,wavelengths=550")));
  EXPECT_TRUE(same_channels(channels("smpte"), channels("hero")));
}

TEST_F(CompareBands, AreMeasuredOneByOneAndTogether) {
  const Outcome o = compare({"--wavelengths", "bands,wavelengths=551,680,800", "--rms", "0.5"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("is enough for an RMS of 0.5"));
  const auto j = nlohmann::json::parse(file("compare.json"));
  EXPECT_EQ(j["band_nm"], (nlohmann::json{551, 680, 800}));
  EXPECT_EQ(j["unit"], "radiance over that of white");
  const auto noise_of = [&j](const char* channel) {
    const auto row = row_of(j["comparison"],
                            {{"candidate", "leaf_lambert"}, {"samples", 4}, {"region", "leaf"}, {"channel", channel}});
    EXPECT_TRUE(row["flip"].is_null());
    return double(row["noise"]);
  };
  double sum = 0;
  for (const char* band : {"551 nm", "680 nm", "800 nm"}) {
    const double noise = noise_of(band);
    EXPECT_GT(noise, 0) << band;
    sum += noise * noise;
  }
  EXPECT_NEAR(noise_of("all bands"), std::sqrt(sum / 3), 1e-9);
  EXPECT_EQ(std::ranges::count(file("compare.csv"), '\n'), 6 + 2 * 3 * 2 * 4);
  EXPECT_THAT(file("bands.svg"), AllOf(HasSubstr("<svg"), HasSubstr("wavelength (nm)")));
  EXPECT_THAT(file("index.html"),
              AllOf(HasSubstr("Bias band by band"), HasSubstr("680 nm as green"), Not(HasSubstr("{{"))));
}

/// A band that no path has carried yet has no error estimate.
TEST_F(CompareBands, AreMeasuredOnceAllOfThemAreSeen) {
  const std::string nine = "bands,wavelengths=400,450,500,550,600,650,700,750,800";
  ASSERT_EQ(compare({"--wavelengths", nine}).code, 0);
  const auto report = nlohmann::json::parse(file("compare.json"));
  for (const auto& row : report["comparison"]) {
    EXPECT_EQ(row["samples"], 4);
    if (row["region"] == "leaf") {
      EXPECT_GT(row["noise"], 0) << row["channel"];
    }
  }
  EXPECT_THAT(compare({"--wavelengths", "bands,step=10"}).err, HasSubstr("show each band once in 8 samples"));
}

/// Each film alone would fit.
TEST_F(CompareBands, RefuseMoreThanTheMachineHolds) {
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE)), bands = 301, bytes_a_band = 48;
  const double size = std::sqrt(2 * 0.3 * memory / (bands * bytes_a_band));  // the image is twice as wide as high
  const Outcome o = frond_command({"compare", folder_.write("scene.pbrt", kLeafScene).string(), "-o", path("report"),
                                   "--no-cache", "--materials", "abm,leaf_lambert", "--wavelengths",
                                   "bands,lambdamin=400,lambdamax=700,step=1", "--size", fmt::format("{:.0f}", size)});
  EXPECT_THAT(o.err, AllOf(HasSubstr("6 films of"), HasSubstr("--size takes fewer pixels")));
}

TEST_F(CompareBands, RefuseWhatIsForColours) {
  EXPECT_THAT(compare({"--wavelengths", "bands,step=100", "--target", "front"}).err,
              HasSubstr("--target is an RMS of red, green and blue"));
  EXPECT_THAT(compare({"--wavelengths", "bands,wavelengths=551,680", "--materials", "abm@wavelengths=smpte"}).err,
              HasSubstr("its wavelengths \"smpte\" give other channels than the reference's"));
}

}  // namespace
}  // namespace frond::compare
