#include <gmock/gmock.h>

#include <filesystem>

#include "tests/cli/command.h"
#include "tests/support/input_error.h"

/// Arguments and files that a command once took: what it wrote could not be read, or it said nothing of what it left
/// out.
namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Hostile : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.name_of(name); }
  /// Returns the message of a command that has to fail, and to write no file.
  std::string refusal(const std::vector<std::string>& words, const std::string& output = "") const {
    const Outcome o = frond_command(words);
    EXPECT_EQ(o.code, 1) << o.err;
    EXPECT_FALSE(!output.empty() && std::filesystem::exists(path(output))) << output;
    return o.err;
  }
  std::string scene(const std::string& material) {
    return folder_
        .write("scene.pbrt",
               "Camera \"orthographic\"\nFilm \"rgb\" \"integer xresolution\" 2 \"integer yresolution\" 2\nWorldBegin\n"
               "LightSource \"infinite\" \"spectrum L\" \"stdillum-E\"\n" +
                   material + "\nShape \"disk\"\n")
        .string();
  }

  TestFolder folder_{"hostile"};
};

TEST_F(Hostile, CanopiesThatNoTableHoldsAreRefused) {
  const auto canopy = [this](std::vector<std::string> words) {
    words.insert(words.begin(), {"canopy", "-o", path("c.npy"), "--count", "10"});
    return refusal(words, "c.npy");
  };
  for (const std::string option : {"--size=1e300,1e300", "--heights=-1e300,1e300", "--ball=1e300", "--scale=1e300",
                                   "--scale=1e-300", "--apart=1e-300"})
    EXPECT_THAT(canopy({option}), HasSubstr(option.substr(0, option.find('=')))) << option;
  EXPECT_THAT(canopy({"--column", "a=1:2", "--column", "a=3:4"}), HasSubstr("there are two columns \"a\""));
  EXPECT_THAT(canopy({"--column", "a=-1e308:1e308"}), HasSubstr("the largest of a table"));
  EXPECT_THAT(canopy({"--column", std::string(20000, 'a') + "=1:2"}), HasSubstr("10000 is the limit"));
}

TEST_F(Hostile, TimeLimitsThatEndAMeasurementAreToldOf) {
  const std::string leaf = scene("Material \"leaf_lambert\"");
  for (const std::string command : {"brf", "flux"})
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"--paths", "4294967296"}, std::vector<std::string>{"--rms", "1e-300"}}) {
      std::vector<std::string> all{command,     leaf, "--target",     "-1,1,-1,1,1", "--wavelengths", "551",
                                   "--threads", "1",  "--time-limit", "1",           "--no-cache",    "-q"};
      all.insert(all.end(), words.begin(), words.end());
      if (command == "brf") all.insert(all.end(), {"--zenith", "0"});
      const Outcome o = frond_command(all);
      EXPECT_EQ(o.code, 0) << o.err;
      EXPECT_THAT(o.err, HasSubstr(words[0] == "--rms" ? "warning: --rms 1e-300 was not reached"
                                                       : "paths were traced, not 4294967296"))
          << command;
    }
}

TEST_F(Hostile, CheckReadsTables) {
  folder_.write("mutant.csv", "rubbish\n");
  for (const std::string model : {"leaf_simplified", "leaf_solved"}) {
    const auto checked = [&](const std::string& file) {
      return refusal({"check", scene("Material \"" + model + "\" \"string tablefile\" \"" + file + "\"")});
    };
    EXPECT_THAT(checked("mutant.csv"), HasSubstr("mutant.csv")) << model;
    EXPECT_THAT(checked("missing.csv"), AllOf(HasSubstr("scene.pbrt:5:"), HasSubstr("No such file"))) << model;
  }
}

TEST_F(Hostile, EveryReaderOfCsvNamesAFileWithoutRows) {
  for (const char* text : {"", "\n", "# a comment\n"}) {
    const std::string csv = folder_.write("none.csv", text).string();
    const std::string leaf = scene("Material \"diffuse\"");
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"fit", csv, "-o", path("fit.pbrt")},
             {"instances", csv, "-o", path("i.npy")},
             {"spectrophotometer", "diffuse,reflectance=" + csv, "--wavelengths", "500"},
             {"spectrophotometer", "leaf_simplified,tablefile=" + csv, "--wavelengths", "500"},
             {"brf", leaf, "--wavelengths", "bands,responses=" + csv}})
      EXPECT_THAT(refusal(words), HasSubstr("none.csv")) << words[0];
  }
}

TEST_F(Hostile, ATableOfNoInstancesIsRefused) {
  const std::string csv = folder_.write("none.csv", "x,y,z\n").string();
  EXPECT_THAT(refusal({"instances", csv, "-o", path("i.npy")}, "i.npy"),
              HasSubstr("none.csv:1:1: the file has no rows"));
}

TEST_F(Hostile, WhatIsFixedIsWhatAMaterialTakes) {
  for (const std::string fixed : {"thickness=1e30", "thickness=1e-320", "chlorophylla=1e308", "spongyaspect=1e300"})
    EXPECT_THAT(refusal({"fit", "--data", "wavelength,R,T\n550,0.1,0.1\n", "--like", "soybean", "--fix", fixed, "-o",
                         path("o.pbrt")},
                        "o.pbrt"),
                AllOf(HasSubstr("--fix " + fixed.substr(0, fixed.find('='))), HasSubstr("outside its range")));
}

TEST_F(Hostile, ExposuresBeyondAFloatAreRefused) {
  EXPECT_THAT(refusal({"convert", path("a.exr"), "--exposure", "2000", "-o", path("x.exr")}, "x.exr"),
              HasSubstr("--exposure"));
  EXPECT_THAT(refusal({"compare", scene("Material \"leaf_lambert\""), "--rms", "2"}), HasSubstr("--rms"));
}

TEST_F(Hostile, MessagesHaveNoControlCharacters) {
  const std::string said = refusal({"check", scene("Material \"\x1b[2J\x7f\" \"float \x1b[31m\" 1")});
  EXPECT_THAT(said, AllOf(HasSubstr("?[2J?"), Not(HasSubstr("\x1b"))));
  const std::string cut("wavelength,R,T\n550,a\0b,0.1\n", 27);
  const auto file = folder_.write("d.csv", cut);
  EXPECT_THAT(refusal({"fit", file.string(), "--like", "soybean"}), HasSubstr("\"a?b\" was given"));
}

}  // namespace
}  // namespace frond
