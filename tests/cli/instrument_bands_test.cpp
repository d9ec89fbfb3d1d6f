#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/support/command_test.h"

/// Bands with responses under an instrument, whose light is an illuminant.
namespace frond {
namespace {

using ::testing::HasSubstr;

constexpr double kZ = 5;  // one false alarm in 1.7 million

/// A plate whose reflectance rises from 0.1 at 500 nm to 0.5 at 700 nm, under a light that rises from 1 to 3.
class InstrumentBands : public CommandTest {
 protected:
  InstrumentBands() {
    folder_.write("wide.spd", "500 1 700 1");
    folder_.write("narrow.spd", "590 1 610 1");
    folder_.write("rising.spd", "400 0 500 1 700 3 800 3");
    folder_.write("plate.spd", "400 0.1 500 0.1 700 0.5 800 0.5");
  }
  Outcome measured(const std::string& instrument, const Words& more) const {
    return frond_command({instrument, "diffuse,reflectance=" + path("plate.spd"), "--rays", "1e6", "--no-cache",
                          "--wavelengths", "bands,responses=" + path("wide.spd") + "," + path("narrow.spd")},
                         more);
  }
};

TEST_F(InstrumentBands, AreWeightedByTheIlluminant) {
  // The mean of 0.1 + 0.4 x under 1 + 2 x for x from 0 to 1 is 1/30 above that under a constant.
  for (const auto& [illuminant, mean] :
       {std::pair{std::string("stdillum-E"), 0.3}, {path("rising.spd"), 0.3 + 1.0 / 30}}) {
    const Outcome o = measured("spectrophotometer", {"--illuminant", illuminant, "--json", "-", "-q"});
    ASSERT_EQ(o.code, 0) << o.err;
    const auto json = nlohmann::json::parse(o.out);
    const auto& wide = json["measurements"][0];
    const auto& narrow = json["measurements"][1];
    EXPECT_EQ(wide["band"], "wide");
    EXPECT_EQ(narrow["band"], "narrow");
    EXPECT_EQ(wide["wavelength_nm"], 600);
    EXPECT_NEAR(wide["R"].get<double>(), mean, kZ * wide["R_se"].get<double>());
    EXPECT_LT(wide["R_se"].get<double>(), 1e-3);
    EXPECT_NEAR(narrow["R"].get<double>(), 0.3, kZ * narrow["R_se"].get<double>() + 1e-3);
    EXPECT_THAT(json["notes"].dump(), HasSubstr("Bands are weighted by response and illuminant: " + illuminant));
  }
  EXPECT_THAT(measured("spectrophotometer", {}).out,
              HasSubstr("\nBands are weighted by response and illuminant: stdillum-E\n"));
}

TEST_F(InstrumentBands, AreThoseOfTheGoniophotometer) {
  const Outcome o = measured(
      "goniophotometer", {"--illuminant", path("rising.spd"), "--patches", "2x1", "--integrate", "--json", "-", "-q"});
  ASSERT_EQ(o.code, 0) << o.err;
  const auto json = nlohmann::json::parse(o.out);
  const auto& share = json["summary"][0];
  EXPECT_EQ(share["band"], "wide");
  EXPECT_EQ(share["measured_by"], "1000000 rays");  // no integral over wavelengths
  EXPECT_NEAR(share["share"].get<double>(), 0.3 + 1.0 / 30, kZ * share["share_se"].get<double>());
}

TEST_F(InstrumentBands, NeedAnIlluminantThatCoversThem) {
  folder_.write("short.spd", "400 1 650 1");
  folder_.write("dark.spd", "400 1 500 0 700 0 710 1");
  const auto error = [&](const std::string& light) {
    return measured("spectrophotometer", {"--illuminant", light}).err;
  };
  EXPECT_THAT(error(path("short.spd")), HasSubstr("is known from 400 to 650 nm, band wide needs 500 to 700 nm"));
  EXPECT_THAT(error(path("dark.spd")), HasSubstr("is 0 in band wide"));
  EXPECT_THAT(error("stdillum-Q"), HasSubstr("stdillum-Q"));
  const auto at = [](const std::string& nm, const std::string& more) {
    return frond_command({"spectrophotometer", "diffuse", "--wavelengths", nm, "--rays", "1e3", "--illuminant", more})
        .err;
  };
  EXPECT_THAT(at("551", "stdillum-D65"), HasSubstr("--illuminant has no effect on single wavelengths"));
  EXPECT_THAT(at("smpte", "stdillum-D65"), HasSubstr("an instrument needs wavelengths, as in 450,550"));
  EXPECT_THAT(at("300", "stdillum-D65"), HasSubstr("--wavelengths: wavelengths from 360 to 2500 (nm) are needed"));
}

}  // namespace
}  // namespace frond
