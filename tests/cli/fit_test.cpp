#include "leaf/fit/fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "jobs/record/job.h"
#include "leaf/tissue/specimen_file.h"
#include "tests/cli/table.h"
#include "tests/support/command_test.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kSpectrum =
    "# a leaf\nnm,R,T\n450,0.045,0.016\n550,0.08,0.15\n650,0.05,0.05\n680,0.045,0.02\n"
    "720,0.25,0.28\n800,0.44,0.45\n1200,0.41,0.44\n1450,0.12,0.15\n1650,0.29,0.33\n"
    "1940,0.04,0.03\n2200,0.12,0.16\n";

class Fitting : public CommandTest {
 protected:
  std::string spectrum_ = folder_.write("leaf.csv", kSpectrum).string();
};

TEST_F(Fitting, WritesALeafThatAScenesReaderTakes) {
  const std::string leaf = path("leaf.pbrt"), json = path("leaf.json"), csv = path("fitted.csv");
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
  EXPECT_EQ(j["prospect"][0]["name"], "N");
  EXPECT_LT(j["rmse_prospect"], 0.05);
  EXPECT_THAT(done.out, HasSubstr("PROSPECT-D, fitted to the same R and T: RMSE 0.0"));
  const std::string scene =
      folder_
          .write(
              "scene.pbrt",
              "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\nInclude \"leaf.pbrt\"\nShape \"disk\"\n")
          .string();
  EXPECT_EQ(frond_command({"check", "--strict", scene}).code, 0);
}

TEST_F(Fitting, NamesWhatItDerivesAndWhatItDoesNotUse) {
  std::string with_a = "nm,R,A,comment\n";
  for (const auto& row : parse_csv(kSpectrum).rows)
    with_a += fmt::format("{},{},{},x\n", row[0], row[1], 1 - std::stod(row[1]) - std::stod(row[2]));
  const auto fitted = [this](const std::string& csv) {
    const std::string json = path("fit.json");
    const auto done = frond_command({"fit", csv, "--json", json, "--structure", "bifacial", "--sieve", "off"});
    EXPECT_EQ(done.code, 0) << done.err;
    return std::pair(done.out + done.err, nlohmann::json::parse(bytes_of(json)));
  };
  const auto [text, json] = fitted(folder_.write("a.csv", with_a).string());
  EXPECT_THAT(text, AllOf(HasSubstr("T = 1 - R - A"), HasSubstr("columns that are not used: comment")));
  const double wanted = fitted(spectrum_).second["rmse_T"];
  EXPECT_NEAR(double(json["rmse_T"]), wanted, 1e-6);
  std::string only_r = "nm,R\n";
  for (const auto& row : parse_csv(kSpectrum).rows) only_r += row[0] + "," + row[1] + "\n";
  const auto [r_text, r_json] = fitted(folder_.write("r.csv", only_r + "2300,.11\n2400,.08\n").string());
  EXPECT_THAT(r_text, Not(HasSubstr(", T 0")));
  EXPECT_TRUE(r_json["rmse_T"].is_null());
  EXPECT_TRUE(r_json["rmse_R"].is_number());
}

// The fitted leaf is the measured one, so that the differences by direction are small.
TEST_F(Fitting, ComparesByDirection) {
  const std::string table = path("directions.csv"), spectra = path("spectra.csv"), json = path("fit.json");
  const std::string nm = "450,500,550,600,650,680,720,760,800,900,1000,1200,1450,1650";
  ASSERT_EQ(frond_command({"goniophotometer", "leaf_solved,specimen=soybean-lopex", "--angles", "20", "--wavelengths",
                           nm, "--integrate", "--csv", table})
                .code,
            0);
  ASSERT_EQ(frond_command({"spectrophotometer", "measured,filename=" + table, "--angles", "20", "--wavelengths", nm,
                           "--rays", "1e5", "--csv", spectra})
                .code,
            0);
  const auto done = frond_command({"fit", spectra, "--directions", table, "--json", json});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(done.out, AllOf(HasSubstr("by direction"), HasSubstr("BRDF   RMS"), HasSubstr("BTDF   RMS")));
  const auto rows = nlohmann::json::parse(bytes_of(json))["directions"];
  ASSERT_EQ(rows.size(), 28u);
  for (const auto& row : rows) {
    EXPECT_NEAR(row["fitted_per_sr"], double(row["measured_per_sr"]), 0.003) << row;
    EXPECT_LT(row["rms_per_sr"], 0.006) << row;
  }
  const auto wrong = frond_command({"fit", spectra, "--directions", spectrum_});
  EXPECT_NE(wrong.code, 0);
  EXPECT_THAT(wrong.err, HasSubstr("there is no column \"incidence_deg\""));
}

TEST_F(Fitting, SaysWhatIsWrongBeforeItBegins) {
  const auto error = [this](const Words& more) {
    const auto done = frond_command({"fit", spectrum_}, more);
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
  const std::string json = path("leaf.json");
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
  const auto absorption = [this](const Words& more) {
    const std::string json = path("leaf.json");
    EXPECT_EQ(frond_command({"fit", spectrum_, "--json", json, "--sieve", "on"}, more).code, 0);
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
  const std::string json = path("leaf.json"), chart = path("leaf.svg");
  const auto done = frond_command({"fit", folder_.write("dark.csv", dark).string(), "--json", json, "--plot", chart});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(done.out, AllOf(HasSubstr("off by more than 0.01"), HasSubstr("lowest R")));
  EXPECT_THAT(bytes_of(chart), AllOf(HasSubstr("off by more than 0.01"), HasSubstr("lowest R of this structure"),
                                     // Marks in the legend and in the panel, of a band of one wavelength too.
                                     ::testing::ContainsRegex("d='M-.9-.9[^>]*#d55e00(.|\n)*d='M-.9-.9[^>]*#d55e00")));
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

/// Fits of many leaves: of the leaf column of a file, and of several files.
class FittingMany : public Fitting {
 protected:
  /// Rows of kSpectrum as rows of a leaf, times `scale`.
  static std::string rows(const std::string& leaf, double scale) {
    std::string text;
    for (const auto& [nm, r, t] : std::initializer_list<std::array<double, 3>>{{450, .045, .016},
                                                                               {550, .08, .15},
                                                                               {650, .05, .05},
                                                                               {680, .045, .02},
                                                                               {720, .25, .28},
                                                                               {800, .44, .45},
                                                                               {1200, .41, .44},
                                                                               {1450, .12, .15},
                                                                               {1650, .29, .33},
                                                                               {1940, .04, .03},
                                                                               {2200, .12, .16}})
      text += fmt::format("{},{},{},{}\n", leaf, nm, r * scale, t * scale);
    return text;
  }
  /// Runs frond fit with --structure and --sieve, which save time, and returns the table.
  CsvTable fitted(const Words& words) {
    const std::string csv = path("fits.csv");
    done_ = frond_command(joined({"fit"}, words), {"--structure", "bifacial", "--sieve", "on", "--csv", csv});
    EXPECT_EQ(done_.code, 0) << done_.err;
    return parse_csv(bytes_of(csv));
  }
  static std::vector<std::string> words_of(const CsvTable& table, const std::string& column) {
    std::vector<std::string> words;
    for (size_t row = 0; row < table.rows.size(); ++row) words.push_back(table.text(row, column));
    return words;
  }
  Outcome done_{};
};

TEST_F(FittingMany, ABadLeafLosesNoOther) {
  const std::string file = folder_
                               .write("many.csv", "leaf,nm,R,T\n" + rows("good", 1) + "bad,450,.1,.1\nbad,550,x,.1\n" +
                                                      rows("dim", .9) + "few,450,.1,.1\nabove,450,.9,.9\n")
                               .string();
  const CsvTable table = fitted({file, "--all-leaves", "-o", path("leaves.pbrt")});
  ASSERT_EQ(table.rows.size(), 5u);
  const auto column = [&](const char* name) { return words_of(table, name); };
  EXPECT_THAT(column("leaf"), ::testing::ElementsAre("good", "bad", "dim", "few", "above"));
  const auto status = column("status");
  EXPECT_EQ(status[0], "fitted");
  EXPECT_THAT(status[1], AllOf(HasSubstr("many.csv:14:9"), HasSubstr("\"x\" was given")));
  EXPECT_EQ(status[2], "fitted");
  EXPECT_THAT(status[3], HasSubstr("fewer than the"));
  EXPECT_THAT(status[4], HasSubstr("R + T is 1.8"));
  EXPECT_THAT(done_.out, AllOf(HasSubstr("5 leaves: 2 fitted, 3 failed"), HasSubstr("bad: ")));
  EXPECT_EQ(column("rmse")[1], "");
  EXPECT_GT(std::stod(column("chlorophylla_se")[0]), 0);
  const std::string scene = bytes_of(path("leaves.pbrt"));
  EXPECT_THAT(scene, AllOf(HasSubstr("MakeNamedMaterial \"good\" \"string type\" \"leaf\""), HasSubstr("\"dim\"")));
  EXPECT_THAT(scene, ::testing::Not(HasSubstr("\"bad\"")));
}

/// The leaves that the structure is learned from are named wherever a leaf follows them.
TEST_F(FittingMany, LearnsThePriorOfLeavesWithoutTransmittance) {
  const std::string both = folder_.write("both.csv", "leaf,nm,R,T\n" + rows("a", 1) + rows("b", .9)).string(),
                    more = folder_.write("more.csv", "leaf,nm,R,T\n" + rows("c", .8) + rows("d", .95)).string();
  std::string reflectance = "nm,R\n";
  for (int nm = 450; nm <= 2200; nm += 125) reflectance += fmt::format("{},{}\n", nm, nm < 700 ? 0.06 : 0.3);
  const std::string alone = folder_.write("alone.csv", reflectance).string();
  const auto done = frond_command(
      {"fit", alone, "--prior", both, "--prior", more, "--json", path("fit.json"), "-o", path("leaf.pbrt")});
  ASSERT_EQ(done.code, 0) << done.err;
  const char* kNamed = "T was not measured: the structure follows a prior, that of 4 leaves of both.csv, more.csv";
  EXPECT_THAT(done.out, AllOf(HasSubstr(kNamed), HasSubstr("from the prior: not determined by the data")));
  EXPECT_THAT(bytes_of(path("leaf.pbrt")), HasSubstr(kNamed));
  const auto j = nlohmann::json::parse(bytes_of(path("fit.json")));
  EXPECT_EQ(j["prior"], "4 leaves of both.csv, more.csv");
  EXPECT_EQ(j["structure_prior"].size(), 6u);
  EXPECT_EQ(words_of(fitted({alone, "--all-leaves"}), "prior")[0], "seven leaves of LOPEX93 and Davis");
  EXPECT_THAT(done_.out, HasSubstr("1 with R alone or T alone"));
  EXPECT_EQ(words_of(fitted({both, "--all-leaves", "--prior", both, "--prior", more}), "prior")[0], "");
  EXPECT_THAT(done_.err, HasSubstr("--prior has no effect"));
  const auto error = [&](const Words& priors) {
    const auto wrong = frond_command({"fit", alone}, priors);
    EXPECT_NE(wrong.code, 0);
    return wrong.err;
  };
  EXPECT_THAT(error({"--prior", both}), HasSubstr("at least 3 leaves are needed, not 2"));
  EXPECT_THAT(error({"--prior", both, "--prior", alone}), AllOf(HasSubstr("alone.csv"), HasSubstr("R alone")));
  EXPECT_THAT(error({"--prior", both, "--like", "soybean"}), HasSubstr("--like"));
}

/// A leaf's fit depends neither on the others nor on the number of threads.
TEST_F(FittingMany, IsTheFitOfEachLeafAlone) {
  const std::string file =
      folder_.write("two.csv", "leaf,nm,R,T\n" + rows("a", 1) + rows("b", 0.8) + rows("c", 0.9)).string();
  const CsvTable one = fitted({file, "--all-leaves", "--threads", "1"});
  const std::string csv = bytes_of(path("fits.csv"));
  fitted({file, "--all-leaves", "--threads", "3"});
  EXPECT_EQ(csv, bytes_of(path("fits.csv")));
  const std::string json = path("b.json");
  ASSERT_EQ(
      frond_command({"fit", file, "--leaf", "b", "--structure", "bifacial", "--sieve", "on", "--json", json}).code, 0);
  const auto j = nlohmann::json::parse(bytes_of(json));
  EXPECT_NEAR(std::stod(words_of(one, "rmse")[1]), j["rmse"].get<double>(), 1e-9);
  for (const auto& number : j["numbers"])
    EXPECT_NEAR(std::stod(words_of(one, number["name"].get<std::string>())[1]) / number["value"].get<double>(), 1,
                1e-8);
}

TEST_F(FittingMany, FilesCanShareNamesOfLeaves) {
  const std::string a = folder_.write("a.csv", "leaf,nm,R,T\n" + rows("oak", 1)).string(),
                    b = folder_.write("b.csv", "leaf,nm,R,T\n" + rows("oak", .9)).string();
  const CsvTable table = fitted({a, b, spectrum_, path("missing.csv"), "-o", path("leaves.pbrt")});
  EXPECT_THAT(words_of(table, "file"), ::testing::ElementsAre("a.csv", "b.csv", "leaf.csv", "missing.csv"));
  EXPECT_THAT(words_of(table, "leaf"), ::testing::ElementsAre("oak", "oak", "leaf", "missing"));
  EXPECT_EQ(words_of(table, "status")[1], "fitted");
  EXPECT_NE(words_of(table, "thickness")[0], words_of(table, "thickness")[1]);
  EXPECT_THAT(words_of(table, "status")[3], HasSubstr("missing.csv"));
  EXPECT_THAT(bytes_of(path("leaves.pbrt")), AllOf(HasSubstr("\"a.csv/oak\""), HasSubstr("\"b.csv/oak\"")));
}

/// A stop as by Ctrl-C.
TEST_F(FittingMany, WritesNothingIfItIsStopped) {
  const JobInfo& job = find_job("fit");
  Arguments args(params_of(job), command_spelling);
  args.set("file", folder_.write("two.csv", "leaf,nm,R,T\n" + rows("a", 1) + rows("b", 0.8)).string());
  args.set("all-leaves", "true");
  args.set("csv", path("fits.csv"));
  args.set("output", path("leaves.pbrt"));
  JobContext context(silent_log(), session_options(args));
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW(run_job(job, {context, args, {.stop = source.get_token()}}), Stopped);
  EXPECT_FALSE(std::filesystem::exists(path("fits.csv")));
  EXPECT_FALSE(std::filesystem::exists(path("leaves.pbrt")));
}

TEST_F(FittingMany, OfOneLeafIsATableToo) { EXPECT_EQ(fitted({spectrum_, "--all-leaves"}).rows.size(), 1u); }

/// The table states every number of a leaf that its scene file has: lignin, which follows cellulose, was missing.
TEST_F(FittingMany, TheTableHasWhatTheSceneFileHas) {
  for (const char* tables : {"prospect", "baranoski"}) {
    const CsvTable table =
        fitted({spectrum_, "--all-leaves", "--absorption", tables, "--fix", "water=0.008g/cm2", "-o", path("a.pbrt")});
    std::istringstream in(bytes_of(path("a.pbrt")));
    int numbers = 0;
    for (std::string line; std::getline(in, line);) {
      const std::string name = "    \"float ";
      if (!line.starts_with(name)) continue;
      const size_t end = line.find('"', name.size());
      const double value = std::stod(line.substr(end + 1));
      ++numbers;
      // With one kind of tables a leaf has none of the constituents that only the other kind has.
      if (value != 0) {
        EXPECT_NEAR(table.number(0, line.substr(name.size(), end - name.size())) / value, 1, 1e-5) << line;
      }
    }
    EXPECT_EQ(numbers, 17);
  }
}

/// The specimen file has the leaves of the table and the leaf of the means, which lies between two leaves; the scene
/// file ends with a material that is one of the leaves for each instance. The standard error of R is 0.001: a right
/// program fails by chance in less than one of 10,000 seeds.
TEST_F(FittingMany, WritesASpecimenFile) {
  const std::string file = folder_.write("two.csv", "leaf,nm,R,T\n" + rows("a", 1) + rows("b", 0.8)).string();
  const CsvTable fits = fitted({file, "--all-leaves", "--specimens", path("leaves.csv"), "-o", path("leaves.pbrt")});
  const std::string csv = bytes_of(path("leaves.csv"));
  EXPECT_THAT(csv, AllOf(HasSubstr("standard deviations of the logarithms over the leaves: thickness "),
                         HasSubstr("\na,soybean,bifacial,true,prospect,"), HasSubstr("\nmean,")));
  leaf::TissueParams leaf;
  for (const size_t row : {size_t(0), size_t(1)}) {
    leaf = leaf::parse_specimen(csv, "leaves.csv", words_of(fits, "leaf")[row]);
    for (const leaf::LeafNumber& n : leaf::fit_variables())
      if (!n.only_with || *n.only_with == leaf::AbsorptionTables::prospect) {
        EXPECT_NEAR(n.value(leaf) / fits.number(row, std::string(n.name)), 1, 1e-8) << n.name;
      }
  }
  EXPECT_EQ(leaf.number("protein"), 0);  // PROSPECT-D has no protein, the specimen has
  EXPECT_EQ(leaf, leaf::parse_specimen(bytes_of(path("fits.csv")), "fits.csv", "b"));  // tables of fits have the same
  const auto r = [&](const char* name) {
    const auto done = frond_command({"spectrophotometer", "leaf_solved,specimenfile=" + path("leaves.csv") + ":" + name,
                                     "--wavelengths", "550", "--rays", "1e5", "--csv", path("r.csv")});
    EXPECT_EQ(done.code, 0) << done.err;
    return parse_csv(bytes_of(path("r.csv"))).number(0, "R");
  };
  EXPECT_NEAR(r("mean"), (r("a") + r("b")) / 2, 0.005);
  EXPECT_THAT(bytes_of(path("leaves.pbrt")),
              AllOf(HasSubstr("MakeNamedMaterial \"all leaves\" \"string type\" \"mix\" \"texture select\" \"leaf\""),
                    HasSubstr("\"string materials\" [ \"a\" \"b\" ]")));
  EXPECT_THAT(frond_command({"fit", spectrum_, "--specimens", path("x.csv")}).err, HasSubstr("add --all-leaves"));
}

TEST_F(FittingMany, SaysWhatIsWrongBeforeItBegins) {
  const auto error = [](const Words& words) {
    const auto done = frond_command({"fit"}, words);
    EXPECT_NE(done.code, 0);
    return done.err;
  };
  EXPECT_THAT(error({spectrum_, "--all-leaves", "--leaf", "oak"}), HasSubstr("--all-leaves"));
  EXPECT_THAT(error({spectrum_, spectrum_, "--leaf", "oak"}), HasSubstr("selects a leaf of one file"));
  EXPECT_THAT(error({spectrum_, "--all-leaves", "--plot", "a.svg"}), HasSubstr("--plot draws one leaf"));
  EXPECT_THAT(error({spectrum_, "--all-leaves", "--fix", "clorophylla=1"}), HasSubstr("did you mean"));
  EXPECT_THAT(error({spectrum_, "--fix", "Cab=40"}),
              HasSubstr("PROSPECT's Cab is chlorophyll, as chlorophyll=40ug/cm2"));
  EXPECT_THAT(error({path("none.csv"), "--all-leaves"}), HasSubstr("none.csv"));
  const std::string two = folder_.write("two.csv", "leaf,nm,R\na,550,.1\nb,550,.1\n").string();
  EXPECT_THAT(error({two}), AllOf(HasSubstr("--leaf selects one of a, b"), HasSubstr("--all-leaves takes all")));
  EXPECT_THAT(error({two, "--all-leaves"}), AllOf(HasSubstr("no leaf could be fitted"), HasSubstr("fewer")));
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
