#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/support/command_test.h"

/// `frond flux --times`: the light of a day.
namespace frond {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

using Json = nlohmann::json;

class FluxTimes : public CommandTest {
 protected:
  /// Measures two leaves over a soil. `sky`: parameters of the light.
  Outcome measured(const std::string& sky, std::vector<std::string> words, const std::string& light = "sky") {
    const auto scene = folder_.write(
        "scene.pbrt",
        "Option \"float period\" [2 2]\nWorldBegin\nLightSource \"" + light + "\" " + sky +
            "\nMakeNamedMaterial \"soil\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0.3 2500 0.3]\n"
            "MakeNamedMaterial \"leaf\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0.1 2500 0.6]\n"
            "NamedMaterial \"soil\" Shape \"bilinearmesh\" \"point3 P\" [0 0 0  2 0 0  0 2 0  2 2 0]\n"
            "NamedMaterial \"leaf\" ObjectBegin \"leaf\" Shape \"disk\" \"float radius\" 0.5 ObjectEnd\n"
            "Translate 1 1 1 ObjectInstance \"leaf\" Translate 0.5 0 1 Rotate 60 0 1 0 ObjectInstance \"leaf\"\n");
    words.insert(words.begin(),
                 {"flux", scene.string(), "--no-cache", "--paths", "4000", "--wavelengths", "400:700:50"});
    return frond_command(words);
  }
  std::string times(const std::string& rows) { return folder_.write("day.csv", rows).string(); }
  Json json_of(const std::string& sky, std::vector<std::string> words) {
    words.insert(words.end(), {"--json", "-", "-q"});
    const Outcome outcome = measured(sky, words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Json::parse(outcome.out);
  }
};

/// Returns the rows with a value of a column.
std::vector<Json> rows_of(const Json& table, const std::string& column, const Json& value) {
  std::vector<Json> rows;
  for (const Json& row : table)
    if (row[column] == value) rows.push_back(row);
  return rows;
}

TEST_F(FluxTimes, StepsEqualSingleMeasurementsAndTheDayIsTheirSum) {
  const std::string table = times(
      "time,elevation,azimuth,ghi,dhi,water\n"
      "2026-06-21T04:00,-5,10,0,0,1\n2026-06-21T06:00,12,20,180,70,1\n2026-06-21T09:00,40,60,600,150,2\n"
      "2026-06-21T12:00,61,100,400,380,1.5\n2026-06-22T06:00,11,20,100,80,1\n");
  const Json day = json_of("\"float ozone\" 0.3", {"--times", table});
  const std::vector<std::pair<std::string, std::string>> single{
      {"2026-06-21T06:00",
       "\"float elevation\" 12 \"float azimuth\" 20 \"float globalirradiance\" 180 \"float "
       "diffuseirradiance\" 70 \"float water\" 1 \"integer day\" 172"},
      {"2026-06-21T09:00",
       "\"float elevation\" 40 \"float azimuth\" 60 \"float globalirradiance\" 600 \"float "
       "diffuseirradiance\" 150 \"float water\" 2 \"integer day\" 172"},
      {"2026-06-21T12:00",
       "\"float elevation\" 61 \"float azimuth\" 100 \"float globalirradiance\" 400 \"float "
       "diffuseirradiance\" 380 \"float water\" 1.5 \"integer day\" 172"}};
  // Each step stands for half of the time to its neighbours: 2.5, 3 and 10.5 hours.
  const double hours[] = {2.5, 3, 10.5};
  double incident = 0, leaf = 0;
  for (size_t i = 0; i < single.size(); ++i) {
    const Json one = json_of("\"float ozone\" 0.3 " + single[i].second, {});
    const std::vector<Json> rows = rows_of(day["flux"], "time", single[i].first);
    ASSERT_EQ(rows.size(), one["flux"].size());
    for (size_t r = 0; r < rows.size(); ++r) {
      EXPECT_EQ(rows[r]["share"], one["flux"][r]["share"]);
      EXPECT_EQ(rows[r]["share_se"], one["flux"][r]["share_se"]);
      if (rows[r]["quantity"] == "absorbed" && rows[r]["material"] == "leaf" && rows[r]["wavelength_nm"] == "PAR") {
        const double photons = rows[r]["share"].get<double>() * one["par_umol_m2_s"].get<double>();
        EXPECT_NEAR(rows[r]["par_umol_m2_s"], photons, 1e-6 * photons);
        leaf += photons * hours[i] * 3600e-6;
      }
    }
    const Json step = rows_of(day["steps"], "time", single[i].first).at(0);
    EXPECT_EQ(step["par_umol_m2_s"], one["par_umol_m2_s"]);
    incident += one["par_umol_m2_s"].get<double>() * hours[i] * 3600e-6;
  }
  ASSERT_EQ(day["par_mol_m2"].size(), 2u);
  EXPECT_NEAR(day["par_mol_m2"][0], incident, 1e-6 * incident);
  for (const Json& row : day["flux_days"])
    if (row["date"] == "2026-06-21" && row["quantity"] == "absorbed" && row["material"] == "leaf") {
      EXPECT_NEAR(row["par_mol_m2"], leaf, 1e-6 * leaf);
      EXPECT_NEAR(row["share"], leaf / incident, 1e-6);
    }
  for (const Json& row : rows_of(day["flux"], "time", "2026-06-21T04:00")) EXPECT_EQ(row["share"], 0);
  EXPECT_EQ(day["steps"][0]["par_umol_m2_s"], 0);
}

TEST_F(FluxTimes, InstancesHaveRowsOfEachTimeAndSumsOfTheDay) {
  const std::string table = times("time,elevation\n2026-06-21T10:00Z,30\n2026-06-21T12:00Z,60\n2026-06-21T22:00Z,-9\n");
  const Json day = json_of("", {"--times", table, "--by", "instance"});
  ASSERT_EQ(day["instances"].size(), 6u);
  const double sum =
      1e-6 * 3600 *
      (2 * day["instances"][1]["par_umol_m2_s"].get<double>() + 6 * day["instances"][3]["par_umol_m2_s"].get<double>());
  EXPECT_EQ(day["instances_days"][1]["instance"], 2);
  EXPECT_NEAR(day["instances_days"][1]["par_mol_m2"], sum, 1e-6 * sum);
  EXPECT_EQ(day["instances"][5]["par_umol_m2_s"], 0);
  EXPECT_GT(day["instances"][5]["area"], 0.7);
  EXPECT_EQ(measured("", {"--times", table, "--by", "instance", "--csv", path("leaves.csv"), "-q"}).code, 0);
  for (const char* name : {"leaves.csv", "leaves-flux.csv", "leaves-steps.csv", "leaves-flux_days.csv"})
    EXPECT_TRUE(std::filesystem::exists(path(name))) << name;
}

TEST_F(FluxTimes, ThePlaceGivesThePositionOfTheSun) {
  const Json day =
      json_of("", {"--times", times("Time;Latitude (deg);Longitude (deg)\n2026-06-21 11:00+02:00;47.38;8.54\n"
                                    "2026-06-21 23:00+02:00;47.38;8.54\n")});
  EXPECT_NEAR(day["steps"][0]["elevation_deg"], 52.147, 0.01);
  EXPECT_GT(day["steps"][0]["par_umol_m2_s"], 1000);
  EXPECT_EQ(day["steps"][1]["par_umol_m2_s"], 0);
}

TEST_F(FluxTimes, OtherLightsHaveTheirParametersByName) {
  const std::string table = times("time,scale\n2026-06-21T10:00,1\n2026-06-21T12:00,0\n");
  const Outcome outcome = measured("\"spectrum L\" \"stdillum-E\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0]",
                                   {"--times", table, "--csv", "-", "-q"}, "distant");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("2026-06-21T12:00,reflected,,400,0,0,"));
}

TEST_F(FluxTimes, ColumnsWithoutEffectAreNamedInAWarning) {
  const Outcome outcome =
      measured("", {"--times", times("time,elevation,temp_air,aerosl\n2026-06-21T10:00,30,20,0.1\n")});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("columns without effect, no parameter of light \"sky\": \"temp_air\""));
  EXPECT_THAT(outcome.err, HasSubstr("\"aerosl\""));
  EXPECT_THAT(outcome.err, HasSubstr("aerosol"));
}

TEST_F(FluxTimes, BadTablesAreErrorsWithTheirPosition) {
  const auto error = [this](const std::string& rows, std::vector<std::string> words = {}) {
    words.insert(words.end(), {"--times", times(rows)});
    const Outcome outcome = measured("", words);
    EXPECT_EQ(outcome.code, 1) << rows;
    return outcome.err;
  };
  EXPECT_THAT(error("elevation\n30\n"), HasSubstr("day.csv:1:1: a column time is needed"));
  EXPECT_THAT(error("time,elevation\nnoon,30\n"), HasSubstr("day.csv:2:1: \"noon\" is no time"));
  EXPECT_THAT(error("time,latitude\n2026-06-21T10:00Z,47\n"), HasSubstr("latitude and longitude belong together"));
  EXPECT_THAT(error("time,latitude,longitude\n2026-06-21T10:00,47,8\n"), HasSubstr("needs the time zone"));
  EXPECT_THAT(error("time,elevation,sun_zenith,sun_azimuth\n2026-06-21T10:00,30,60,180\n"), HasSubstr("given twice"));
  EXPECT_THAT(error("time,elevation\n2026-06-21T10:00,30\n2026-06-21T09:00,30\n"),
              HasSubstr("day.csv:3:1: the times must ascend"));
  EXPECT_THAT(error("time,elevation,ghi\n2026-06-21T10:00,30,\n"),
              HasSubstr("the column globalirradiance needs a number"));
  EXPECT_THAT(error("time,ghi,globalirradiance\n2026-06-21T10:00,30,30\n"), HasSubstr("there are two columns"));
  EXPECT_THAT(error("time,elevation\n2026-06-21T10:00,-1\n"), HasSubstr("there is no light at any of the 1 times"));
  EXPECT_THAT(error("time,elevation,ghi,dhi\n2026-06-21T10:00,30,100,200\n"),
              HasSubstr("more than \"globalirradiance\" 100"));
  EXPECT_THAT(error("time,elevation\n"), HasSubstr("the table has no rows"));
  EXPECT_THAT(error("time,elevation\n2026-06-21T10:00,30\n", {"--csv", path("a.csv"), "--checkpoint", "10"}),
              HasSubstr("--times"));
}

}  // namespace
}  // namespace frond
