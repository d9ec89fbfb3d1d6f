#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "report/chart.h"
#include "tests/cli/instrument_command.h"
#include "tests/cli/table.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class GoniophotometerCommand : public InstrumentCommand {
 protected:
  GoniophotometerCommand() : InstrumentCommand("goniophotometer") {}
};

TEST_F(GoniophotometerCommand, WritesEachDetectorWithItsSolidAngleAndError) {
  const Outcome o = measure({"--angle", "30", "--wavelengths", "551", "--rays", "1e5", "--csv", "-"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("# material: abm,specimen=soybean\n"));
  EXPECT_THAT(o.out, HasSubstr("the direction that the material's model calls incident"));
  const CsvTable csv = parse_csv(o.out);
  ASSERT_EQ(csv.rows.size(), 20u * 40);
  double solid = 0, reflected = 0, transmitted = 0;
  for (size_t i = 0; i < csv.rows.size(); ++i) {
    EXPECT_EQ(csv.number(i, "theta_max_deg") - csv.number(i, "theta_min_deg"), 9);
    EXPECT_EQ(csv.number(i, "phi_max_deg") - csv.number(i, "phi_min_deg"), 9);
    EXPECT_EQ(csv.text(i, "kind"), csv.number(i, "theta_deg") < 90 ? "BRDF" : "BTDF");
    EXPECT_EQ(csv.number(i, "f_se") > 0, csv.number(i, "caught") > 0);
    solid += csv.number(i, "solid_angle_sr");
    (csv.text(i, "kind") == "BRDF" ? reflected : transmitted) +=
        csv.number(i, "f_per_sr") * csv.number(i, "projected_solid_angle_sr");
  }
  EXPECT_NEAR(solid, 4 * std::numbers::pi, 1e-6);
  const CsvTable shares = parse_csv(frond_command({"spectrophotometer", "abm,specimen=soybean", "--angle", "30",
                                                   "--wavelengths", "551", "--rays", "1e5", "--csv", "-"})
                                        .out);
  EXPECT_NEAR(reflected, shares.number(0, "R"), 1e-6);  // the same rays
  EXPECT_NEAR(transmitted, shares.number(0, "T"), 1e-6);
}

TEST_F(GoniophotometerCommand, JsonSaysTheSameAsCsv) {
  const Outcome o = measure({"--angle", "150", "--wavelengths", "455,551", "--rays", "1e4", "--patches", "4x6", "--csv",
                             path("a.csv"), "--json", "-"});
  ASSERT_EQ(o.code, 0) << o.err;
  const auto json = nlohmann::json::parse(o.out);
  const CsvTable csv = parse_csv(bytes_of(path("a.csv")));
  ASSERT_EQ(json["measurements"].size(), 48u);
  ASSERT_EQ(csv.rows.size(), 48u);
  for (size_t i = 0; i < csv.rows.size(); ++i) {
    const auto& patch = json["measurements"][i];
    EXPECT_EQ(patch["kind"], csv.text(i, "kind"));
    EXPECT_EQ(patch["caught"], csv.number(i, "caught"));
    EXPECT_NEAR(patch["f_per_sr"].get<double>(), csv.number(i, "f_per_sr"), 1e-6);
  }
  EXPECT_EQ(csv.text(0, "kind"), "BTDF");  // lit from the back
}

TEST_F(GoniophotometerCommand, TheSameFileOnAnyNumberOfThreads) {
  for (const char* threads : {"1", "2"})
    ASSERT_EQ(measure({"--wavelengths", "551", "--rays", "2e5", "--threads", threads, "--csv",
                       path(std::string(threads) + ".csv"), "-q"})
                  .code,
              0);
  EXPECT_EQ(bytes_of(path("1.csv")), bytes_of(path("2.csv")));
}

TEST_F(GoniophotometerCommand, DrawsCurvesAndMaps) {
  const Outcome o = measure({"--with", "diffusetransmission", "--angle", "30,45", "--wavelengths", "551,608", "--rays",
                             "1e3", "--plot", path("a.svg"), "--map", path("b.svg"), "--map-scale", "log"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out,
              AllOf(HasSubstr("20 x 40 patches"), ContainsRegex("abm,specimen=soybean +30 +551 +1000 rays +BRDF")));
  for (const char* text : {"abm,specimen=soybean", "diffusetransmission", "551 nm", "608 nm", "BTDF (sr⁻¹)"})
    EXPECT_THAT(bytes_of(path("a.svg")), HasSubstr(text));
  // The line toward the light is dotted, the line of the mirror direction is not.
  for (const char* dash : {"2,3", "none"})
    EXPECT_THAT(bytes_of(path("a.svg")),
                HasSubstr(fmt::format("#808080' stroke-width='1.5' stroke-dasharray='{}'", dash)));
  EXPECT_THAT(bytes_of(path("b.svg")), HasSubstr("BRDF: diffusetransmission"));
  if (!png_refusal().empty()) return;
  ASSERT_EQ(measure({"--wavelengths", "551", "--rays", "100", "--map", path("b.png"), "-q"}).code, 0);
  EXPECT_THAT(bytes_of(path("b.png")), HasSubstr("PNG"));
}

TEST_F(GoniophotometerCommand, IntegratesWhatIsNoEstimate) {
  const Outcome o = measure({"--with", "leaf_solved", "--integrate", "--angle", "30", "--wavelengths", "551", "--rays",
                             "1e4", "--csv", path("a.csv"), "--plot", path("a.svg")});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, ContainsRegex("abm,specimen=soybean +30 +551 +10000 rays +BRDF"));
  EXPECT_THAT(o.out, ContainsRegex("leaf_solved +30 +551 +integration +BTDF"));
  EXPECT_THAT(bytes_of(path("a.svg")), HasSubstr("leaf_solved"));
  const CsvTable csv = parse_csv(bytes_of(path("a.csv")));
  ASSERT_EQ(csv.rows.size(), 1600u);
  EXPECT_EQ(csv.number(0, "rays"), 10000);
  for (size_t i = 800; i < csv.rows.size(); ++i) {
    EXPECT_EQ(csv.number(i, "rays"), 0);
    EXPECT_EQ(csv.number(i, "f_se"), 0);
    EXPECT_GT(csv.number(i, "f_per_sr"), 0);
  }
}

TEST_F(GoniophotometerCommand, RefusesTheImpossibleBeforeItMeasures) {
  EXPECT_THAT(refusal({"--with", "leaf_simplified,surfacedirect=false,tablemethod=solve", "--wavelengths", "551"}),
              HasSubstr("delta lobe"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--patches", "0x40"}), HasSubstr("0 x 40"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--patches", "19x40"}), HasSubstr("horizon"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--patches", "20"}), HasSubstr("20x40"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--patches", "20x41", "--plot", path("a.svg")}), HasSubstr("even"));
  EXPECT_THAT(refusal({"--wavelengths", "400:800:10", "--plot", path("a.svg")}), HasSubstr("at most"));
  EXPECT_THAT(refusal({"--wavelengths", "400:800:10", "--map", path("a.svg")}), HasSubstr("at most"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--map", path("a.gif")}), HasSubstr(".svg or a .png"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--map", path("no/a.svg")}), HasSubstr("there is no folder"));
  EXPECT_THAT(measure({"--wavelengths", "551", "--rays", "0"}).err, HasSubstr("--rays"));
}

}  // namespace
}  // namespace frond
