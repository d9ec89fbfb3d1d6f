#include "tests/cli/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "leaf/table/table_file.h"
#include "leaf/tissue/specimens.h"
#include "tests/support/command_test.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

Outcome table_command(const Words& arguments) { return frond_command({"table"}, arguments); }

TEST(TableCommand, WritesTheTableOfALeaf) {
  const TestFolder folder("table");
  const std::string path = folder.name_of("t.csv");
  const Outcome o = table_command({"specimen=maize,thickness=0.0001", "--wavelengths", "608,551,455", "-o", path});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("3 wavelengths x 181 angles, solve, error at most "));
  const leaf::Table table = leaf::read_table(path, {});
  EXPECT_THAT(table.wavelengths_nm, ElementsAre(608, 551, 455));
  EXPECT_THAT(table.theta_deg, SizeIs(181));
  leaf::TissueParams params = leaf::find_specimen("maize")->params;
  params.thickness_m = 0.0001;
  const leaf::TissueModel model(params);
  EXPECT_EQ(table.at(1, 30), leaf::solve(model.at(551), std::array{30.0})[0]);
}

TEST(TableCommand, WritesToStandardOutput) {
  const Outcome o = table_command({"--method", "montecarlo", "--rays", "1e2", "--seed", "7", "--wavelengths", "551",
                                   "--angles", "0:80:40,85", "-q", "-o", "-"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(o.err, "");
  const leaf::Table table = leaf::parse_table(o.out, "stdout");
  EXPECT_THAT(table.theta_deg, ElementsAre(0, 40, 80, 85));
  EXPECT_THAT(table.standard_errors, SizeIs(4));
  EXPECT_THAT(o.out, HasSubstr("# rays 100, seed 7"));
}

// A Lambertian leaf has PROSPECT's R and T, and not those of the walk that a table would hold.
TEST(TableCommand, RefusesTheSharesOfALeafOfProspect) {
  const Outcome o =
      table_command({"leaf_lambert,N=1.5,Cab=40,Car=8,Cw=0.01,Cm=0.009", "--wavelengths", "551", "-q", "-o", "-"});
  EXPECT_NE(o.code, 0);
  EXPECT_THAT(o.err, HasSubstr("leaf_lambert computes the reflectance and transmittance of PROSPECT itself"));
}

TEST(TableCommand, FoldsBothSidesIntoOne) {
  const auto table_of = [](const Words& more) {
    const Words all = joined({"--wavelengths", "800", "-q", "-o", "-", "--angles"}, more);
    return leaf::parse_table(table_command(all).out, "stdout");
  };
  const leaf::Table folded = table_of({"0:90:30", "--equalsides"}), both = table_of({"0:180:30"});
  EXPECT_TRUE(folded.has_equal_sides());
  EXPECT_DOUBLE_EQ(folded.at(0, 1).transmitted, (both.at(0, 1).transmitted + both.at(0, 5).transmitted) / 2);
}

TEST(TableCommand, WritesModesThatALeafReadsBackToTheBit) {
  const TestFolder folder("modes");
  const std::string path = folder.name_of("maize.modes"), red = "608,551,455";
  const std::string coarse = "tolerance=2e-3";
  const Outcome o = table_command({"leaf_solved,specimen=maize," + coarse, "--wavelengths", red, "-o", path});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("3 wavelengths, BSDF error at most "));
  EXPECT_THAT(o.err, HasSubstr("kB in a render"));
  const auto measured = [&](const std::string& way) {
    return frond_command({"goniophotometer", "leaf_solved,specimen=maize," + coarse + "," + way, "--integrate",
                          "--no-cache", "--angles", "30,120", "--wavelengths", red, "--patches", "4x6", "-q", "--csv",
                          "-"})
        .out;
  };
  const auto figures = [](const std::string& csv) { return csv.substr(csv.find("incidence_deg,")); };
  const auto without_name = [&](const std::string& way) {
    std::string text = figures(measured(way));
    for (size_t at; (at = text.find("," + way)) != text.npos;) text.erase(at, way.size() + 1);
    return text;
  };
  EXPECT_EQ(without_name("tablefile=" + path), without_name("incident=traced"));
  const Outcome finer = table_command({"leaf_solved", "--nodes", "6", "--wavelengths", red, "-o", "-"});
  EXPECT_THAT(finer.out, HasSubstr("# nodes 6\n"));
}

TEST(TableCommand, WritesALeafFileOverDepths) {
  const TestFolder folder("leaf");
  const std::string path = folder.name_of("a.leaf");
  const auto written = [&](const std::string& depths) {
    return table_command({"leaf_solved,tolerance=1e-2", "--wavelengths", "608,551", "--depths", depths, "-o", path});
  };
  ASSERT_EQ(written("0.1,10").code, 0);
  const std::string bytes = bytes_of(path);
  const auto whole = [&](size_t at) {
    uint32_t value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  EXPECT_EQ(whole(16), 2u);   // wavelengths; docs/file_formats.md
  EXPECT_EQ(whole(20), 32u);  // depths: ln(10 / 0.1) in steps of at most 0.15, both ends
  EXPECT_THAT(written("10,0.1").err, HasSubstr("invalid range of depths, 10 to 0.1"));
  EXPECT_THAT(written("-1,10").err, HasSubstr("--depths: 2 numbers from 0 on"));
  EXPECT_THAT(table_command({"--wavelengths", "551", "--depths", "1,2", "-o", path + ".csv"}).err,
              HasSubstr("--depths is for a .leaf file"));
  EXPECT_THAT(table_command({"leaf_simplified", "--wavelengths", "551", "-o", path}).err,
              HasSubstr("a .leaf file is of leaf_solved"));
  EXPECT_EQ(table_command({"--wavelengths", "551", "-o", path}).code, 0);
}

TEST(TableCommand, CheckReportsATableThatLacksTheWavelengths) {
  const TestFolder folder("leaf");
  const std::string table = folder.name_of("a.csv");
  ASSERT_EQ(table_command({"--wavelengths", "400:700:100", "--angles", "0,180", "-o", table}).code, 0);
  const std::string scene =
      folder
          .write("scene.pbrt",
                 "WorldBegin\nLightSource \"infinite\"\nMaterial \"leaf_simplified\" \"string tablefile\" "
                 "\"a.csv\" \"float chlorophylla\" 9\nShape \"disk\"\n")
          .string();
  const Outcome o = frond_command({"check", scene});
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(o.err, HasSubstr("a.csv\" is known from 400 to 700 nm, the render needs 360 to 830 nm"));
  EXPECT_THAT(o.err, HasSubstr("\"chlorophylla\" has no effect with \"tablefile\""));
}

TEST(TableCommand, RefusesOptionsThatModesDoNotHave) {
  for (const char* option : {"--rays", "--seed"})
    EXPECT_THAT(table_command({"leaf_solved", "--wavelengths", "551", "-o", "-", option, "7"}).err,
                HasSubstr(std::string(option) + " is for tables of leaf_simplified"));
  EXPECT_THAT(table_command({"leaf_solved,tablefile=a", "--wavelengths", "551", "-o", "-"}).err,
              HasSubstr("not of a \"tablefile\""));
}

TEST(TableCommand, RefusesWhatItCannotDo) {
  struct {
    std::vector<std::string> arguments;
    std::string message;
  } const kCases[] = {
      {{"--wavelengths", "3000"}, "--wavelengths: a list of numbers from 360 to 2500 (nm)"},
      {{"--wavelengths", "551,551"}, "--wavelengths has 551 twice"},
      {{"--wavelengths", "green"}, "\"green\" was given"},
      {{"--wavelengths", "551", "--angles", "0,200"}, "--angles: a list of numbers from 0 to 180 (degrees)"},
      {{"--wavelengths", "551", "--angles", "20,10"}, "--angles must ascend: 10 follows 20"},
      {{"--wavelengths", "551", "--angles", "91:180:1", "--equalsides"}, "--equalsides needs angles up to 90"},
      {{"--wavelengths", "551", "--method", "montecarlo", "--rays", "0"},
       "--rays: a whole number from 1 to 1000000000"},
      {{"--wavelengths", "551", "thicknes=1"}, "has no parameter \"thicknes\"; did you mean \"thickness\"?"},
      {{"--wavelengths", "551", "thickness"}, "nor name=value of a leaf"},
      {{"abm", "--wavelengths", "551"},
       "\"abm\" is neither a material that looks up a table, as leaf_simplified or leaf_solved"},
      {{"--wavelengths", "551", "specimen=maize", "--specimen", "soybean"},
       "\"specimen\" is given twice, as maize and as soybean"},
      {{"--wavelengths", "551", "--rays", "1e3"}, "--rays is for --method montecarlo"},
      {{"--wavelengths", "551", "--method", "solve", "--seed", "1"}, "--seed is for --method montecarlo"},
      {{"--wavelengths", "551", "--method", "montecarlo", "--nodes", "8"}, "--nodes is for --method solve"},
      {{"--wavelengths", "551", "--method", "montecarlo", "--seed", "-1"}, "a whole number from 0 to 2^64 - 1"},
      {{"--wavelengths", "551", "tablemethod=montecarlo"}, "use --method solve or montecarlo"},
      {{"--wavelengths", "551", "tablerays=7"}, "use --rays"},
      {{"--wavelengths", "551", "tablestep=5"}, "use --angles first:last:step"},
      {{"--wavelengths", "551", "tablefile=a.csv"}, "a table is made of a leaf, not of a \"tablefile\""},
      {{"--wavelengths", "551", "oblateness=2"}, "the table of \"leaf_simplified\" has no parameter \"oblateness\""},
      {{"--wavelengths", "551", "thickness=7"}, "0.01 m"},
      {{"--wavelengths", "551", "--specimen", "oak"}, "soybean, maize"},
  };
  for (const auto& [arguments, message] : kCases) {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {"-o", "-"});
    const Outcome o = table_command(all);
    EXPECT_EQ(o.code, 1) << message;
    EXPECT_THAT(o.err, HasSubstr(message));
    EXPECT_EQ(o.out, "");
  }
  EXPECT_THAT(table_command({"--wavelengths", "551", "-o", "/no/folder/t.csv"}).err, HasSubstr("there is no folder"));
}

}  // namespace
}  // namespace frond
