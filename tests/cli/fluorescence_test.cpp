#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "report/chart.h"
#include "tests/cli/table.h"
#include "tests/support/command_test.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Outcome measured(const std::string& material, std::vector<std::string> more) {
  more.insert(more.begin(), {"spectrophotometer", material, "--fluorescence", "--no-cache"});
  return frond_command(more);
}

TEST(FluorescenceCommand, WritesAMatrixAndABalance) {
  const TestFolder folder("fluorescence");
  const std::string json_file = folder.name_of("f.json");
  const Outcome o = measured("abm,fluorescence=0.01",
                             {"--with", "leaf_solved,fluorescence=0.01", "--excitation", "440,550", "--emission",
                              "685:740:55", "--angles", "8,120", "--rays", "200", "--csv", "-", "--json", json_file});
  ASSERT_EQ(o.code, 0) << o.err;
  const CsvTable csv = parse_csv(o.out);
  EXPECT_EQ(csv.names, (std::vector<std::string>{"theta_deg", "excitation_nm", "emission_nm", "Mb", "Mb_se", "Mf",
                                                 "Mf_se", "rays", "material"}));
  ASSERT_EQ(csv.rows.size(), 16u);
  for (size_t i = 0; i < csv.rows.size(); ++i) {
    const bool is_solved = i >= 8;
    EXPECT_EQ(csv.number(i, "theta_deg"), i % 8 < 4 ? 8 : 120);
    EXPECT_EQ(csv.number(i, "excitation_nm"), i % 4 < 2 ? 440 : 550);
    EXPECT_EQ(csv.number(i, "emission_nm"), i % 2 == 0 ? 685 : 740);
    EXPECT_EQ(csv.number(i, "rays"), is_solved ? 0 : 200);
    EXPECT_EQ(csv.number(i, "Mb_se") == 0, is_solved);
    EXPECT_GT(csv.number(i, "Mb"), 0);
  }
  EXPECT_THAT(o.out, HasSubstr("# material: abm,fluorescence=0.01; emission: Gaussians at 688 and 746 nm"));
  EXPECT_THAT(o.out, HasSubstr("# Mb: photons per nm of emission"));
  const auto json = nlohmann::json::parse(bytes_of(json_file));
  ASSERT_EQ(json["balance"].size(), 8u);
  for (const auto& row : json["balance"]) {
    EXPECT_NEAR(row["residual"], 0, 1e-4);
    EXPECT_GT(row["escape"], 0);
    EXPECT_LT(row["escape"], 1);
  }
}

/// The command reads its own CSV back as the matrices of a leaf.
TEST(FluorescenceCommand, WritesMatricesThatALeafTakes) {
  const TestFolder folder("fluorescence_file");
  const std::string file = folder.name_of("m.csv");
  const std::vector<std::string> at{"--excitation", "400:750:50", "--emission", "640:850:30", "--angles", "8,172"};
  const auto with = [&at](std::vector<std::string> more) {
    more.insert(more.end(), at.begin(), at.end());
    return more;
  };
  ASSERT_EQ(measured("leaf_solved,fluorescence=0.01", with({"--csv", file})).code, 0);
  const Outcome o = measured("leaf_lambert,fluorescencematrices=" + file, with({"--csv", "-"}));
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("emission: matrices of m.csv"));
  const CsvTable made = parse_csv(bytes_of(file)), read = parse_csv(o.out);
  ASSERT_EQ(made.rows.size(), read.rows.size());
  for (size_t i = 0; i < made.rows.size(); ++i)
    for (const char* name : {"theta_deg", "excitation_nm", "emission_nm", "Mb", "Mf"})
      EXPECT_EQ(made.number(i, name), read.number(i, name)) << name;
}

TEST(FluorescenceCommand, DrawsMaps) {
  const TestFolder folder("fluorescence_map");
  const std::string chart = folder.name_of("map.svg");
  const Outcome o = measured("leaf_solved,fluorescence=0.01", {"--excitation", "400:750:50", "--plot", chart});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(bytes_of(chart), HasSubstr("lit side (Mb): leaf_solved,fluorescence=0.01"));
  EXPECT_THAT(measured("leaf_solved", {"--excitation", "440", "--plot", chart}).err,
              HasSubstr("at least two wavelengths of each are needed"));
}

TEST(FluorescenceCommand, MeasuresDirections) {
  const TestFolder folder("fluorescence_directions");
  const std::string plot = folder.name_of("plane.svg"), map = folder.name_of("map.svg"),
                    matrices = folder.name_of("m.csv");
  const Outcome o = frond_command({"goniophotometer", "leaf_solved,fluorescence=0.01",
                                   "--with",          "abm,fluorescence=0.01",
                                   "--fluorescence",  "--no-cache",
                                   "--excitation",    "440",
                                   "--emission",      "685,740",
                                   "--angles",        "8,120",
                                   "--patches",       "6x4",
                                   "--rays",          "2400",
                                   "--csv",           "-",
                                   "--plot",          plot,
                                   "--map",           map});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("# frond 0.1.0 goniophotometer, fluorescence"));
  EXPECT_THAT(o.out, HasSubstr("# material: abm,fluorescence=0.01; emission: Gaussians at 688 and 746 nm"));
  EXPECT_THAT(bytes_of(plot), HasSubstr("440 to 740 nm"));
  EXPECT_THAT(bytes_of(plot), HasSubstr("fluorescence (sr⁻¹ nm⁻¹)"));
  EXPECT_THAT(bytes_of(map), HasSubstr("lit side: leaf_solved,fluorescence=0.01"));
  const CsvTable csv = parse_csv(o.out);
  ASSERT_EQ(csv.rows.size(), 2u * 2 * 2 * 24);
  ASSERT_EQ(frond_command({"spectrophotometer", "leaf_solved,fluorescence=0.01", "--fluorescence", "--no-cache",
                           "--excitation", "440", "--emission", "685,740", "--angles", "8,120", "--csv", matrices})
                .code,
            0);
  const CsvTable m = parse_csv(bytes_of(matrices));
  double sides[2] = {};
  int noisy = 0;
  for (size_t i = 0; i < csv.rows.size(); ++i) {
    EXPECT_EQ(csv.number(i, "rays"), i < 96 ? 0 : 2400);
    noisy += csv.number(i, "f_se") > 0 ? 1 : 0;
    if (i < 96) {
      EXPECT_EQ(csv.number(i, "f_se"), 0);
    }
    EXPECT_EQ(csv.text(i, "kind"), (csv.number(i, "theta_deg") < 90) == (i % 96 < 48) ? "lit side" : "other side");
    sides[csv.text(i, "kind") == "other side"] +=
        csv.number(i, "f_per_sr_nm") * csv.number(i, "projected_solid_angle_sr");
    if (i >= 96 || i % 24 < 23) continue;
    EXPECT_EQ(csv.number(i, "emission_nm"), m.number(i / 24, "emission_nm"));
    EXPECT_EQ(csv.number(i, "excitation_nm"), 440);
    EXPECT_NEAR(sides[0], m.number(i / 24, "Mb"), 3e-4 * sides[0]);
    EXPECT_NEAR(sides[1], m.number(i / 24, "Mf"), 3e-4 * sides[1]);
    sides[0] = sides[1] = 0;
  }
  EXPECT_GT(noisy, 90);  // at grazing angles few walks of 100 leave
}

TEST(FluorescenceCommand, FilesForOthersNameWhatTheyLeaveOut) {
  const TestFolder folder("fluorescence_exports");
  const std::string out = folder.name_of("t.csv");
  EXPECT_THAT(frond_command({"table", "fluorescence=0.01", "--wavelengths", "551", "-o", out}).err,
              HasSubstr("\"fluorescence\" is left out: a table holds no fluorescence"));
  EXPECT_THAT(frond_command({"export", "leaf_solved,fluorescence=0.01", "--format", "csv", "--wavelengths", "551",
                             "--angles", "30", "--view-angles", "30", "--view-azimuths", "0", "--no-cache", "-o", out})
                  .err,
              HasSubstr("\"fluorescence\" is left out: --format csv holds no fluorescence"));
  const std::string matrices =
      folder.write("m.csv", "excitation_nm,emission_nm,Mb,Mf\n400,640,0,0\n400,850,0,0\n750,640,0,0\n750,850,0,0\n");
  for (const auto& [leaf, name] :
       {std::pair<std::string, std::string>{"\"leaf_solved\" \"float fluorescence\" 0.01", "fluorescence"},
        {"\"leaf_lambert\" \"string fluorescencematrices\" \"m.csv\"", "fluorescencematrices"}}) {
    const std::string scene =
        folder.write("s.pbrt", "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\nMaterial " + leaf +
                                   "\nShape \"sphere\"\n");
    EXPECT_THAT(frond_command({"export", scene, "--format", "mitsuba", "--no-cache", "-o", folder.name_of(name)}).err,
                HasSubstr("\"" + name + "\" is left out: Mitsuba renders no fluorescence"));
  }
  EXPECT_THAT(bytes_of(folder.name_of("fluorescence/scene.xml")), Not(HasSubstr("name=\"fluorescence\"")));
}

TEST(FluorescenceCommand, SaysWhatIsMissing) {
  EXPECT_THAT(frond_command({"goniophotometer", "abm"}).err, HasSubstr("--wavelengths is needed"));
  EXPECT_THAT(frond_command({"goniophotometer", "diffuse", "--fluorescence"}).err, HasSubstr("has no fluorescence"));
  EXPECT_THAT(frond_command({"goniophotometer", "abm", "--fluorescence", "--integrate"}).err, HasSubstr("--integrate"));

  EXPECT_THAT(measured("diffuse", {}).err, HasSubstr("diffuse has no fluorescence; leaf_solved, abm have"));
  EXPECT_THAT(measured("abm", {"--excitation", "440", "--emission", "740", "--rays", "2"}).err,
              HasSubstr("abm emits nothing: fluorescence=0.01 gives leaf_solved, abm a quantum yield"));
  EXPECT_THAT(measured("abm", {"--wavelengths", "550"}).err, HasSubstr("--wavelengths"));
  EXPECT_THAT(measured("abm", {"--excitation", "300:400:50"}).err, HasSubstr("from 400 to 750"));
  EXPECT_THAT(measured("abm", {"--emission", "740,700"}).err, HasSubstr("ascending order"));
  EXPECT_THAT(frond_command({"spectrophotometer", "abm", "--wavelengths", "550", "--excitation", "440"}).err,
              HasSubstr("--fluorescence"));
}

}  // namespace
}  // namespace frond
