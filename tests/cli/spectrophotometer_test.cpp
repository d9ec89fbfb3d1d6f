#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "report/chart.h"
#include "tests/cli/instrument_command.h"
#include "tests/cli/table.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

class SpectrophotometerCommand : public InstrumentCommand {
 protected:
  SpectrophotometerCommand() : InstrumentCommand("spectrophotometer") {}
};

TEST_F(SpectrophotometerCommand, WritesCsvWithUnitsAndErrors) {
  const Outcome o = measure({"--angles", "0,8", "--wavelengths", "455:608:76.5", "--rays", "1e4", "--csv", "-"});
  ASSERT_EQ(o.code, 0) << o.err;
  const CsvTable csv = parse_csv(o.out);
  EXPECT_EQ(csv.names, (std::vector<std::string>{"theta_deg", "wavelength_nm", "Rs", "Rd", "R", "T", "A", "Rs_se",
                                                 "Rd_se", "R_se", "T_se", "A_se", "rays", "material"}));
  ASSERT_EQ(csv.rows.size(), 6u);
  for (size_t i = 0; i < csv.rows.size(); ++i) {
    EXPECT_EQ(csv.number(i, "theta_deg"), i < 3 ? 0 : 8);
    EXPECT_EQ(csv.number(i, "rays"), 10000);
    EXPECT_EQ(csv.text(i, "material"), "abm,specimen=soybean");
    EXPECT_NEAR(csv.number(i, "R") + csv.number(i, "T") + csv.number(i, "A"), 1, 1e-8);
    EXPECT_NEAR(csv.number(i, "Rs") + csv.number(i, "Rd"), csv.number(i, "R"), 1e-8);
    EXPECT_GT(csv.number(i, "A_se"), 0);
  }
  EXPECT_THAT(o.out, HasSubstr("# material: abm,specimen=soybean\n"));
  EXPECT_THAT(o.out, HasSubstr("# seed: 0\n"));
  EXPECT_THAT(o.out, HasSubstr("the direction that the material's model calls incident"));
}

TEST_F(SpectrophotometerCommand, RsAndRdAreBlankWhereTheMaterialDoesNotTell) {
  const Outcome o =
      measure({"--with", "diffuse,reflectance=0.5", "--wavelengths", "551", "--rays", "1000", "--csv", "-"});
  ASSERT_EQ(o.code, 0) << o.err;
  const CsvTable csv = parse_csv(o.out);
  ASSERT_EQ(csv.rows.size(), 2u);
  EXPECT_NE(csv.text(0, "Rs"), "");
  for (const char* column : {"Rs", "Rd", "Rs_se", "Rd_se"}) EXPECT_EQ(csv.text(1, column), "");
  EXPECT_NEAR(csv.number(1, "R"), 0.5, 1e-6);
  EXPECT_EQ(csv.text(1, "material"), "diffuse,reflectance=0.5");
}

TEST_F(SpectrophotometerCommand, JsonSaysTheSameAsCsv) {
  const Outcome o = measure({"--with", "diffuse", "--wavelengths", "455,551", "--rays", "1e4", "--csv", path("a.csv"),
                             "--json", "-", "--seed", "7"});
  ASSERT_EQ(o.code, 0) << o.err;
  const auto json = nlohmann::json::parse(o.out);
  const CsvTable csv = parse_csv(bytes_of(path("a.csv")));
  ASSERT_EQ(json["measurements"].size(), csv.rows.size());
  for (size_t i = 0; i < csv.rows.size(); ++i)
    for (const std::string& name : csv.names) {
      const auto& value = json["measurements"][i][name];
      if (value.is_number()) {
        EXPECT_NEAR(value.get<double>(), csv.number(i, name), 1e-3 * std::abs(value.get<double>())) << name;
      } else {
        EXPECT_EQ(value.is_null() ? "" : value.get<std::string>(), csv.text(i, name));
      }
    }
}

TEST_F(SpectrophotometerCommand, TheSameFileOnAnyNumberOfThreads) {
  for (const char* threads : {"1", "2"})
    ASSERT_EQ(measure({"--wavelengths", "551,800", "--rays", "2e5", "--threads", threads, "--csv",
                       path(std::string(threads) + ".csv"), "-q"})
                  .code,
              0);
  EXPECT_EQ(bytes_of(path("1.csv")), bytes_of(path("2.csv")));
}

TEST_F(SpectrophotometerCommand, AReadingDoesNotDependOnTheOthers) {
  const auto rows = [&](const std::string& angles) {
    return parse_csv(measure({"--angles", angles, "--wavelengths", "551", "--rays", "1e4", "--csv", "-"}).out).rows;
  };
  EXPECT_EQ(rows("0,8")[1], rows("8")[0]);
}

TEST_F(SpectrophotometerCommand, PrintsATableForPeople) {
  const Outcome o = measure({"--wavelengths", "551", "--rays", "1000"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, StartsWith("abm,specimen=soybean\n"));
  EXPECT_THAT(o.out, HasSubstr(" ± "));
}

TEST_F(SpectrophotometerCommand, StopsAtAStandardError) {
  const Outcome o = measure({"--wavelengths", "455", "--se", "1e-3", "--csv", "-"});
  ASSERT_EQ(o.code, 0) << o.err;
  const CsvTable csv = parse_csv(o.out);
  for (const char* column : {"R_se", "T_se", "A_se"}) EXPECT_LE(csv.number(0, column), 1e-3);
  EXPECT_THAT(measure({"--wavelengths", "455", "--se", "1e-6", "--rays", "1e4"}).err, HasSubstr("1 of 1 measurements"));
}

TEST_F(SpectrophotometerCommand, AtNinetyDegreesItSaysWhatTheFigureIs) {
  const Outcome o = measure({"--angles", "90", "--wavelengths", "551", "--rays", "1000", "--csv", "-"});
  EXPECT_NEAR(parse_csv(o.out).number(0, "Rs"), 1, 1e-5);
  EXPECT_THAT(o.out, HasSubstr("At 90 degrees light meets neither side"));
}

TEST_F(SpectrophotometerCommand, DrawsCharts) {
  for (const char* name : {"a.svg", "a.png"}) {
    if (name[2] == 'p' && !png_refusal().empty()) continue;
    ASSERT_EQ(
        measure({"--wavelengths", "455,551", "--angles", "0:80:40", "--rays", "100", "--plot", path(name), "-q"}).code,
        0);
    EXPECT_THAT(bytes_of(path(name)), HasSubstr(name[2] == 's' ? "</svg>" : "PNG"));
  }
  // Both quantities go upward, and curves have their names at their ends.
  EXPECT_THAT(bytes_of(path("a.svg")),
              ::testing::AllOf(HasSubstr(">abm,specimen=soybean<"), HasSubstr(">551 nm<"), HasSubstr(">reflectance R<"),
                               HasSubstr(">transmittance T<"), ::testing::Not(HasSubstr("1 − T"))));
}

TEST_F(SpectrophotometerCommand, MaterialsTakeSpectraAndMaterials) {
  const auto reflectance = [&](const Words& arguments) {
    const Outcome o = frond_command(joined({"spectrophotometer"}, arguments),
                                    {"--wavelengths", "650", "--rays", "1000", "--csv", "-"});
    EXPECT_EQ(o.code, 0) << o.err;
    return parse_csv(o.out).number(0, "R");
  };
  folder_.write("half.spd", "400 0.1\n900 0.5\n");
  folder_.write("one half.spd", "400 0.1\n900 0.5\n");
  EXPECT_NEAR(reflectance({"diffuse,reflectance=" + path("half.spd")}), 0.3, 1e-6);
  EXPECT_NEAR(reflectance({"diffuse,reflectance=" + path("one half.spd")}), 0.3, 1e-6);
  EXPECT_NEAR(reflectance({"diffuse,reflectance=600,0.2,700,0.4"}), 0.3, 1e-6);
  EXPECT_NEAR(reflectance({"diffuse,reflectance=0.7,0.7,0.7"}), 0.7, 1e-3);
  EXPECT_NEAR(reflectance({"mix,materials=diffuse,diffuse"}), 0.5, 1e-6);
}

TEST_F(SpectrophotometerCommand, MeasuresPlugIns) {
  const Outcome o = frond_command({"spectrophotometer", "wrong_warp", "--plugin", FROND_TEST_PLUGINS "/planted.so",
                                   "--wavelengths", "551", "--rays", "1e4", "--csv", "-"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NEAR(parse_csv(o.out).number(0, "A"), 0.2, 1e-6);
  EXPECT_THAT(measure({"--with", "wrong_warp", "--wavelengths", "551"}).err, HasSubstr("unknown material"));
}

TEST_F(SpectrophotometerCommand, RefusesTheImpossibleBeforeItMeasures) {
  EXPECT_THAT(refusal({"--wavelengths", "300"}), HasSubstr("from 360 to 2500 (nm)"));
  EXPECT_THAT(refusal({"--with", "diffuse,reflectance=.5,.5,.5", "--wavelengths", "551,900"}),
              HasSubstr("\"reflectance\" is known from 360 to 830 nm, 900 nm was asked for"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--angles", "181"}), HasSubstr("from 0 to 180 (degrees)"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--angles", "0:180"}), HasSubstr("--angles"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--with", "abm,thicknes=1e-4"}),
              HasSubstr("did you mean \"thickness\"?"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--with", "abm,thickness"}), HasSubstr("looks like name=value"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--with", "abn"}), HasSubstr("did you mean \"abm\"?"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--csv", path("no/such/folder.csv")}), HasSubstr("there is no folder"));
  EXPECT_THAT(refusal({"--wavelengths", "551,600", "--plot", path("a.jpg")}), HasSubstr(".svg or a .png"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--plot", path("a.svg")}), HasSubstr("two values"));
  EXPECT_THAT(refusal({"--wavelengths", "551", "--csv", "-", "--json", "-"}), HasSubstr("standard output"));
  EXPECT_THAT(refusal({}), HasSubstr("--wavelengths"));
  EXPECT_THAT(measure({"--wavelengths", "551", "--rays", "0"}).err, HasSubstr("--rays"));
}

}  // namespace
}  // namespace frond
