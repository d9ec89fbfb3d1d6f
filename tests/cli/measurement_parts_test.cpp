#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "system/file_bytes.h"
#include "tests/support/command_test.h"

/// Parts of brf and flux, and their merge. tests/submit runs whole jobs.
namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class MeasurementParts : public CommandTest {
 protected:
  void SetUp() override {
    // A distant light has few wavelengths and one direction: it loads faster than a sky.
    for (const auto& [name, light] :
         {std::pair{"scene.pbrt", "\"distant\" \"point3 from\" [-1 0 2] \"point3 to\" [0 0 0]"},
          {"sky.pbrt", "\"sky\""}})
      folder_.write(
          name,
          fmt::format(
              "Option \"float period\" [1 1]\nWorldBegin\nLightSource {}\n"
              "Material \"diffuse\" \"spectrum reflectance\" [300 0.2 2500 0.2]\n"
              "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n"
              "Material \"diffusetransmission\" Shape \"trianglemesh\" \"point3 P\" [0 0 1 0.5 0 1 0.5 1 1 0 1 1] "
              "\"integer indices\" [0 1 2 0 2 3]\n",
              light));
    folder_.write("day.csv", "time,elevation\n2026-06-21T12:00,60\n2026-06-21T18:00,20\n2026-06-21T23:00,-10\n");
  }
  /// Runs `command` on the scene; in `more`, words that begin with @ are names of files in the folder.
  Outcome run(const Words& command, const Words& more) const {
    const bool has_times = std::ranges::find(command, "--times") != command.end();
    Words words{command[0], path(has_times ? "sky.pbrt" : "scene.pbrt"), "--no-cache", "-q"};
    words.insert(words.end(), command.begin() + 1, command.end());
    for (const std::string& word : more) words.push_back(word.starts_with('@') ? path(word.substr(1)) : word);
    return frond_command(words);
  }
  Outcome part(const Words& command, const std::string& range, const std::string& name, const Words& more = {}) const {
    return run(command, joined({"--samples", range, "--part", "@" + name}, more));
  }
  std::string content(const std::string& name) const { return read_file_bytes(path(name), {}); }
  /// Compares all tables of a measurement of three parts with those of one run.
  void expect_same_tables(const Words& command, const std::vector<std::string>& ranges) const {
    ASSERT_EQ(run(command, {"--csv", "@whole.csv"}).code, 0);
    Words merge{"--csv", "@parts.csv"};
    for (size_t i = 0; i < ranges.size(); ++i) {
      const std::string name = std::to_string(i) + ".part";
      const Outcome o = part(command, ranges[i], name, {"--threads", "1"});
      ASSERT_EQ(o.code, 0) << o.err;
      EXPECT_EQ(o.out, "");
      merge.insert(merge.end(), {"--merge", "@" + name});
    }
    const Outcome merged = run(command, merge);
    ASSERT_EQ(merged.code, 0) << merged.err;
    size_t tables = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path("")))
      if (const std::string name = entry.path().filename().string(); name.starts_with("whole")) {
        EXPECT_EQ(content(name), content("parts" + name.substr(5))) << name;
        ++tables;
      }
    EXPECT_GE(tables, 1u);
  }
};

const Words kFlux{"flux", "--bands", "par,red=600:700", "--by", "mesh", "--paths", "9000"};
const Words kBrf{"brf", "--zenith=0:30:30", "--wavelengths", "550,800", "--paths", "1280"};

TEST_F(MeasurementParts, OfAFluxAddUpToTheLastBit) { expect_same_tables(kFlux, {"5000:9000", "0:10", "10:5000"}); }

TEST_F(MeasurementParts, OfADayHaveAllTimes) {
  expect_same_tables(joined(kFlux, {"--times", path("day.csv")}), {"3000:9000", "0:3000"});
}

TEST_F(MeasurementParts, OfABrfAddUpToTheLastBit) { expect_same_tables(kBrf, {"400:1280", "40:400", "0:40"}); }

TEST_F(MeasurementParts, ThatDoNotFitAreNamed) {
  for (const Words& command : {kFlux, kBrf}) {
    SCOPED_TRACE(command[0]);
    const bool is_flux = command[0] == "flux";
    const std::string end = is_flux ? "9000" : "1280", middle = is_flux ? "4096" : "640";
    ASSERT_EQ(part(command, "0:" + middle, "a.part", {"--resume"}).code, 0);
    ASSERT_EQ(part(command, middle + ":" + end, "b.part", {"--resume"}).code, 0);
    ASSERT_EQ(part(command, "0:" + end, "other.part", {"--seed", "7", "--resume"}).code, 0);
    const auto error = [&](const Words& more) {
      const Outcome o = run(command, joined({"--csv", "@c.csv"}, more));
      EXPECT_EQ(o.code, 1);
      EXPECT_FALSE(std::filesystem::exists(path("c.csv")));
      return o.err;
    };
    EXPECT_THAT(error({"--merge", "@b.part"}),
                HasSubstr(is_flux ? "no part has the paths 0:4096" : "no part has samples 0:5"));
    EXPECT_THAT(error({"--merge", "@a.part"}),
                HasSubstr(is_flux ? "no part has the paths 4096:9000" : "no part has samples 5:10"));
    EXPECT_THAT(
        error({"--merge", "@a.part", "--merge", "@b.part", "--merge", "@a.part"}),
        AllOf(HasSubstr("a.part\" and \""), HasSubstr(is_flux ? "both have paths 0:4096" : "both have samples 0:5")));
    EXPECT_THAT(error({"--merge", "@other.part"}), AllOf(HasSubstr("other.part\" is a part of another measurement"),
                                                         HasSubstr("seed: 0 in this command, 7 in")));
    folder_.write("cut.part", content("a.part").substr(0, content("a.part").size() - 20));
    EXPECT_THAT(error({"--merge", "@cut.part", "--merge", "@b.part"}), HasSubstr("cut.part\""));
    EXPECT_THAT(error({"--merge", "@a.part", "--part", "@d.part"}), HasSubstr("excludes"));
    EXPECT_THAT(part(command, "0:" + end, "a.part").err, HasSubstr("already exists: --resume continues from it"));
    for (const char* name : {"a.part", "b.part", "other.part"}) std::filesystem::remove(path(name));
  }
  EXPECT_THAT(part(kFlux, "0:9001", "a.part").err, HasSubstr("--samples 0:9001 ends above --paths 9000"));
  EXPECT_THAT(part(kFlux, "0:9000", "a.part", {"--csv", "@a.csv"}).err, HasSubstr("--part excludes --csv"));
  EXPECT_THAT(run(kFlux, {"--resume"}).err, HasSubstr("--resume needs --csv or --part"));
}

/// A part with fewer times, as a time limit leaves it, is continued.
TEST_F(MeasurementParts, OfADayGoOnFromWhatTheyHave) {
  const Words command = joined(kFlux, {"--times", path("day.csv")});
  ASSERT_EQ(part(command, "0:9000", "limited.part", {"--time-limit", "1e-9", "--resume"}).code, 1);
  ASSERT_EQ(part(command, "0:9000", "whole.part").code, 0);
  ASSERT_EQ(part(kFlux, "0:9000", "single.part").code, 0);
  EXPECT_THAT(run(command, {"--csv", "@c.csv", "--merge", "@single.part"}).err,
              HasSubstr("is a part of another measurement"));
  ASSERT_EQ(part(command, "0:9000", "whole.part", {"--resume"}).code, 0);
  EXPECT_THAT(part(command, "0:5000", "whole.part", {"--resume"}).err, HasSubstr("has other paths than this command"));
}

TEST_F(MeasurementParts, SubmitDividesMeasurements) {
  const auto submitted = [this](const Words& more) {
    return frond_command(joined({"submit", "flux", path("scene.pbrt"), "--no-cache", "--bands", "par", "--paths",
                                 "9000", "--tasks", "3", "--engine", "snakemake"},
                                more));
  };
  const Outcome o = submitted({"--csv", path("flux.csv"), "--json", path("flux.json")});
  ASSERT_EQ(o.code, 0) << o.err;
  const std::string file = content("flux.csv.snakemake/Snakefile");
  EXPECT_THAT(file, AllOf(HasSubstr("merge = [\"flux\", \"" + path("scene.pbrt") + "\", \"--paths\", \"9000\", "),
                          HasSubstr("\"--csv\", \"" + path("flux.csv") + "\", \"--json\""),
                          HasSubstr("{frond:q} flux {scene:q} {options:q} --paths {amount} --samples")));
  EXPECT_FALSE(std::filesystem::exists(path("flux.csv.snakemake/parts/trial.part")));
  EXPECT_THAT(submitted({}).err, HasSubstr("--csv or --json is needed, which the merge writes"));
  EXPECT_THAT(submitted({"--csv", path("b.csv"), "--rms", "0.1"}).err,
              HasSubstr("--rms needs all samples in one place"));
  EXPECT_THAT(submitted({"--csv", path("b.csv"), "--merge", path("a")}).err, HasSubstr("--merge is set by each task"));
  EXPECT_THAT(submitted({"--csv", path("b.csv"), "--material", "laef"}).err, HasSubstr("no material \"laef\""));
}

}  // namespace
}  // namespace frond
