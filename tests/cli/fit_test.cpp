#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "jobs/record/job.h"
#include "tests/cli/command.h"
#include "tests/cli/table.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kSpectrum =
    "# a leaf\nnm,R,T\n450,0.045,0.016\n550,0.08,0.15\n650,0.05,0.05\n680,0.045,0.02\n"
    "720,0.25,0.28\n800,0.44,0.45\n1200,0.41,0.44\n1450,0.12,0.15\n1650,0.29,0.33\n"
    "1940,0.04,0.03\n2200,0.12,0.16\n";

class Fitting : public ::testing::Test {
 protected:
  TestFolder folder_{"fit"};
  std::string spectrum_ = folder_.write("leaf.csv", kSpectrum).string();
  std::string name_of(const char* name) const { return folder_.name_of(name); }
};

TEST_F(Fitting, WritesALeafThatAScenesReaderTakes) {
  const std::string leaf = name_of("leaf.pbrt"), json = name_of("leaf.json"), csv = name_of("fitted.csv");
  const auto done = frond_command(
      {"fit", spectrum_, "-o", leaf, "--json", json, "--csv", csv, "--structure", "bifacial", "--sieve", "off"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(done.out, AllOf(HasSubstr("RMSE"), HasSubstr("chlorophylla"), HasSubstr("near infrared")));
  EXPECT_THAT(bytes_of(leaf), AllOf(HasSubstr("Material \"leaf\" \"string specimen\" \"soybean\""),
                                    HasSubstr("\"float palisadeaspect\""), HasSubstr("# Fitted to leaf.csv")));
  const auto j = nlohmann::json::parse(bytes_of(json));
  EXPECT_LT(j["rmse"], 0.03);
  EXPECT_EQ(j["spectra"].size(), 11u);
  EXPECT_EQ(j["correlations"].size() + 1, j["correlations"][0].size());
  EXPECT_EQ(parse_csv(bytes_of(csv)).rows.size(), 11u);
  const std::string scene =
      folder_
          .write(
              "scene.pbrt",
              "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\nInclude \"leaf.pbrt\"\nShape \"disk\"\n")
          .string();
  EXPECT_EQ(frond_command({"check", "--strict", scene}).code, 0);
}

TEST_F(Fitting, SaysWhatIsWrongBeforeItBegins) {
  const auto error = [this](std::vector<std::string> more) {
    std::vector<std::string> words{"fit", spectrum_};
    words.insert(words.end(), more.begin(), more.end());
    const auto done = frond_command(words);
    EXPECT_NE(done.code, 0);
    return done.err;
  };
  EXPECT_THAT(error({"--fix", "chlorophylla"}), HasSubstr("chlorophylla=NUMBER"));
  EXPECT_THAT(error({"--fix", "clorophylla=1"}), HasSubstr("did you mean \"chlorophylla\"?"));
  EXPECT_THAT(error({"--fix", "chlorophyll=40"}), HasSubstr("chlorophyll=40ug/cm2"));
  EXPECT_THAT(error({"--fix", "chlorophylla=40ug/m2"}), HasSubstr("ug/cm2, mg/cm2 or g/cm2"));
  EXPECT_THAT(error({"--fix", "spongyaspect=4ug/cm2"}), HasSubstr("is not a content per leaf area"));
  EXPECT_THAT(error({"--fix", "water=0.01g/cm2", "--fix", "thickness=1e-4"}), HasSubstr("give the thickness"));
  EXPECT_THAT(error({"--fix", "chlorophyll=40ug/cm2", "--fix", "chlorophylla=2"}), HasSubstr("is the sum of"));
  EXPECT_THAT(error({"--fix", "water=9g/cm2"}), HasSubstr("outside its range"));
  EXPECT_THAT(error({"--like", "oak"}), HasSubstr("one of soybean, maize"));
  EXPECT_THAT(error({"--like", "maize", "--structure", "bifacial"}), HasSubstr("unifacial"));
  EXPECT_THAT(error({"--leaf", "oak"}), HasSubstr("has no names of leaves"));
  EXPECT_THAT(error({"-o", "/nowhere/leaf.pbrt"}), HasSubstr("/nowhere"));
  const std::string short_one = folder_.write("short.csv", "nm,R\n550,0.1\n").string();
  const auto done = frond_command({"fit", short_one});
  EXPECT_NE(done.code, 0);
  EXPECT_THAT(done.err, HasSubstr("fewer"));
}

TEST_F(Fitting, TakesAndReportsContentsPerLeafArea) {
  const std::string json = name_of("leaf.json");
  const auto done =
      frond_command({"fit", spectrum_, "--json", json, "--structure", "bifacial", "--sieve", "on", "--fix",
                     "chlorophyll=40ug/cm2", "--fix", "water=8mg/cm2", "--fix", "drymatter=0.004g/cm2"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(done.out, AllOf(HasSubstr("per leaf area"), HasSubstr("ug/cm2"), HasSubstr("as given")));
  const auto contents = nlohmann::json::parse(bytes_of(json))["contents"];
  std::map<std::string, double> value;
  for (const auto& row : contents) value[row["name"]] = row["value"];
  EXPECT_NEAR(value["chlorophyll"], 40, 1e-6);
  EXPECT_NEAR(value["water"], 0.008, 1e-9);
  EXPECT_NEAR(value["drymatter"], 0.004, 1e-9);
}

TEST_F(Fitting, AbsorbsAsTheSpecimenThatItIsLike) {
  const auto absorption = [this](std::vector<std::string> more) {
    const std::string json = name_of("leaf.json");
    std::vector<std::string> words{"fit", spectrum_, "--json", json, "--sieve", "on"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(frond_command(words).code, 0);
    return nlohmann::json::parse(bytes_of(json))["absorption"].get<std::string>();
  };
  EXPECT_EQ(absorption({"--structure", "bifacial"}), "prospect");
  EXPECT_EQ(absorption({"--like", "soybean"}), "baranoski");
  EXPECT_EQ(absorption({"--like", "soybean", "--absorption", "prospect"}), "prospect");
  EXPECT_EQ(absorption({"--like", "walnut"}), "prospect");
}

/// 0.001 in the red is darker than any surface of the model.
TEST_F(Fitting, NamesTheBandsThatItMisses) {
  std::string dark = "nm,R,T\n";
  for (int nm = 400; nm <= 1000; nm += 20)
    dark += fmt::format("{},{},{}\n", nm, nm < 700 ? 0.001 : 0.44, nm < 700 ? 0.001 : 0.45);
  const std::string json = name_of("leaf.json"), chart = name_of("leaf.svg");
  const auto done = frond_command({"fit", folder_.write("dark.csv", dark).string(), "--json", json, "--plot", chart});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(done.out, AllOf(HasSubstr("off by more than 0.01"), HasSubstr("lowest R")));
  EXPECT_THAT(bytes_of(chart), AllOf(HasSubstr("off by more than 0.01"), HasSubstr("lowest R of this structure")));
  bool found = false;
  const auto j = nlohmann::json::parse(bytes_of(json));
  for (const auto& band : j["misfits"])
    if (band["quantity"] == "R" && band["below_reach"]) {
      found = true;
      EXPECT_GT(band["lowest_R"], 0.01);
      EXPECT_GE(band["from_nm"], 400);
      EXPECT_LE(band["to_nm"], 700);
    }
  EXPECT_TRUE(found);
}

/// Arguments of the job as a program gives them: measurements in a text, names without dashes.
class FittingData : public ::testing::Test {
 protected:
  static Result fit(const std::vector<std::pair<std::string, std::string>>& given) {
    const JobInfo& job = find_job("fit");
    Arguments args(params_of(job), python_spelling);
    for (const auto& [name, value] : given) args.set(name, value);
    JobContext context(silent_log(), session_options(args));
    return run_job(job, {context, args});
  }
  static std::string refusal(const std::vector<std::pair<std::string, std::string>>& given) {
    return error_of([&] { fit(given); });
  }
};

TEST_F(FittingData, IsTheSameAsAFile) {
  const TestFolder folder("fit");
  const std::string file = folder.write("leaf.csv", kSpectrum).string();
  const Result a = fit({{"data", kSpectrum}, {"structure", "bifacial"}, {"sieve", "off"}});
  const Result b = fit({{"file", file}, {"structure", "bifacial"}, {"sieve", "off"}});
  ASSERT_EQ(a.tables.size(), b.tables.size());
  for (size_t i = 0; i < a.tables.size(); ++i) EXPECT_EQ(to_csv(a.tables[i], {}), to_csv(b.tables[i], {}));
}

TEST_F(FittingData, IsRefusedAsAFileIs) {
  EXPECT_THAT(refusal({{"data", "nm,R\n550,-1\n"}}), HasSubstr("R is a share of the light, from 0 to 1"));
  EXPECT_THAT(refusal({{"data", "nm,R,T\n550,0.7,0.6\n"}}), HasSubstr("R + T is 1.3"));
  EXPECT_THAT(refusal({{"data", "nm,theta_deg,R\n550,200,0.1\n"}}), HasSubstr("theta_deg is from 0 to 180 degrees"));
  EXPECT_THAT(refusal({{"data", kSpectrum}, {"angle", "200"}}), HasSubstr("angle: a number from 0 to 180 (degrees)"));
  EXPECT_THAT(refusal({{"data", kSpectrum}, {"like", "maize"}, {"structure", "bifacial"}}),
              HasSubstr("like maize is unifacial, which contradicts structure"));
  for (const char* value : {"-1", "nan", "inf", "", "1x"})
    EXPECT_THAT(refusal({{"data", kSpectrum}, {"fix", std::string("chlorophylla=") + value}}),
                HasSubstr("chlorophylla=NUMBER is needed, 0 at least"))
        << value;
  EXPECT_THAT(refusal({{"data", kSpectrum}, {"fix", "thickness=0"}}), HasSubstr("thickness is above 0"));
  EXPECT_THAT(refusal({{"data", kSpectrum}, {"leaf", "oak"}}), HasSubstr("has no names of leaves: leaf has no effect"));
  EXPECT_THAT(refusal({{"data", kSpectrum}, {"file", "a.csv"}}), HasSubstr("file excludes data"));
  EXPECT_THAT(refusal({}), HasSubstr("measured spectra are needed"));
}

}  // namespace
}  // namespace frond
