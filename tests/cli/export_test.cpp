#include <gmock/gmock.h>

#include <numbers>
#include <sstream>

#include "tests/cli/table.h"
#include "tests/support/command_test.h"

namespace frond {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class ExportCommand : public CommandTest {
 protected:
  static Outcome exported(const Words& words) { return frond_command(joined({"export"}, words), {"--no-cache"}); }
  static std::string refusal(const Words& words) { return refusal_of(joined({"export"}, words), {"--no-cache"}); }
  /// Rows of a matrix of the file: those of a direction, in its first block.
  static std::vector<std::vector<double>> matrix(const std::string& xml, const std::string& direction) {
    size_t at = xml.find("<WavelengthDataDirection>" + direction);
    at = xml.find("<ScatteringData>", at) + std::string("<ScatteringData>").size();
    std::istringstream lines(xml.substr(at, xml.find("</ScatteringData>", at) - at));
    std::vector<std::vector<double>> rows;
    for (std::string line; std::getline(lines, line);) {
      if (line.find(',') == std::string::npos) continue;
      rows.emplace_back();
      std::istringstream numbers(line);
      for (std::string number; std::getline(numbers, number, ',');) rows.back().push_back(std::stod(number));
    }
    return rows;
  }
};

TEST_F(ExportCommand, RadianceHoldsADiffuseSheetExactly) {
  const Outcome o = exported({"diffusetransmission,reflectance=0.3,transmittance=0.4", "--format", "radiance",
                              "--wavelengths", "551", "-o", "-", "-q"});
  ASSERT_EQ(o.code, 0) << o.err;
  for (const auto& [direction, share] : {std::pair{"Reflection Front", 0.3},
                                         {"Reflection Back", 0.3},
                                         {"Transmission Front", 0.4},
                                         {"Transmission Back", 0.4}}) {
    const auto rows = matrix(o.out, direction);
    ASSERT_EQ(rows.size(), 145u);
    for (const auto& row : rows) {
      ASSERT_EQ(row.size(), 145u);
      for (const double f : row) EXPECT_NEAR(f, share / std::numbers::pi, 1e-6);
    }
  }
}

TEST_F(ExportCommand, RadianceHasColourOfSeveralWavelengthsAndKeepsGreyGrey) {
  const Outcome o =
      exported({"diffuse,reflectance=0.5", "--format", "radiance", "--wavelengths", "450,550,650", "-o", "-", "-q"});
  ASSERT_EQ(o.code, 0) << o.err;
  for (const char* block : {"Visible", "CIE-X", "CIE-Z"}) {
    const size_t at = o.out.find(std::string(">") + block + "</Wavelength>");
    ASSERT_NE(at, std::string::npos) << block;
    EXPECT_NEAR(matrix(o.out.substr(at), "Reflection Back")[3][5], 0.5 / std::numbers::pi, 1e-6);
  }
}

TEST_F(ExportCommand, LeavesAreReciprocalUnlessTheySayOtherwise) {
  const auto asymmetry = [](const std::vector<std::string>& leaf) {
    std::vector<std::string> words = leaf;
    words.insert(words.end(), {"--format", "radiance", "--wavelengths", "551", "-o", "-", "-q"});
    const Outcome o = exported(words);
    EXPECT_EQ(o.code, 0) << o.err;
    const auto down = matrix(o.out, "Transmission Back"), up = matrix(o.out, "Transmission Front");
    // Patch 0 is about the normal: light from ring 5 to it, and from it to any patch of this ring, which are equal.
    return std::abs(down[0][70] - up[70][0]) / down[0][70];
  };
  EXPECT_LT(asymmetry({"leaf_solved"}), 1e-4);
  EXPECT_GT(asymmetry({"leaf_solved,incident=traced"}), 1e-2);
}

TEST_F(ExportCommand, CsvSaysWhatTheInstrumentsMeasure) {
  const Outcome o = exported({"leaf_solved", "--format", "csv", "--wavelengths", "551", "--angles", "45",
                              "--view-angles", "4.5,40.5", "--view-azimuths", "0,90,180", "-o", "-", "-q"});
  ASSERT_EQ(o.code, 0) << o.err;
  const CsvTable csv = parse_csv(o.out);
  ASSERT_EQ(csv.rows.size(), 2u * (2 + 2 * 3 * 2));
  for (const auto& [side, angle] : {std::pair{"front", "45"}, {"back", "135"}}) {
    const CsvTable shares =
        parse_csv(frond_command({"spectrophotometer", "leaf_solved,incident=reciprocal", "--angle", angle,
                                 "--wavelengths", "551", "--rays", "1e5", "--csv", "-", "--no-cache", "-q"})
                      .out);
    const CsvTable patches = parse_csv(
        frond_command({"goniophotometer", "leaf_solved,incident=reciprocal", "--angle", angle, "--wavelengths", "551",
                       "--integrate", "--patches", "180x72", "--csv", "-", "--no-cache", "-q"})
            .out);
    int compared = 0;
    for (size_t i = 0; i < csv.rows.size(); ++i) {
      if (csv.text(i, "side") != side) continue;
      const std::string quantity = csv.text(i, "quantity");
      if (quantity == "R" || quantity == "T") {
        // 1e5 rays: 5 standard errors, a false alarm in 1.7 million
        EXPECT_NEAR(csv.number(i, "value"), shares.number(0, quantity), 5 * shares.number(0, quantity + "_se"));
        ++compared;
        continue;
      }
      const double theta_o = csv.number(i, "theta_o_deg");
      const bool below = (quantity == "f_t") == (std::string(side) == "front");
      for (size_t p = 0; p < patches.rows.size(); ++p)
        if (patches.number(p, "theta_deg") == (below ? 180 - theta_o : theta_o) &&
            patches.number(p, "phi_deg") == csv.number(i, "phi_o_deg")) {
          EXPECT_NEAR(csv.number(i, "value"), patches.number(p, "f_per_sr"), 0.01 * patches.number(p, "f_per_sr"));
          ++compared;
        }
    }
    EXPECT_EQ(compared, 14);
  }
}

TEST_F(ExportCommand, OslKeepsAllLightOfADiffuseSheet) {
  const Outcome o = exported(
      {"diffusetransmission,reflectance=0.3,transmittance=0.4", "--format", "osl", "--rays", "100", "-o", "-"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("does not tell its surface from its body"));
  EXPECT_THAT(o.out, HasSubstr("color(0.300000, 0.300000, 0.300000)"));
  EXPECT_THAT(o.out, HasSubstr("color(0.400000, 0.400000, 0.400000)"));
}

TEST_F(ExportCommand, ColoursOfADiffuseSheet) {
  const auto of = [](const char* format) {
    const Outcome o =
        exported({"diffusetransmission,reflectance=0.3,transmittance=0.4", "--format", format, "-o", "-"});
    EXPECT_EQ(o.code, 0) << o.err;
    return o;
  };
  const Outcome gltf = of("gltf"), materialx = of("materialx");
  EXPECT_THAT(gltf.err, AllOf(HasSubstr("linear sRGB under D65"), HasSubstr("lost: the back")));
  EXPECT_THAT(gltf.out, AllOf(HasSubstr("\"diffuseTransmissionFactor\": 0.4"), HasSubstr("\"specularFactor\": 0")));
  EXPECT_THAT(materialx.err, Not(HasSubstr("lost: the back")));
  EXPECT_THAT(materialx.out, HasSubstr("\"base_color\" type=\"color3\" value=\"0.5, 0.5, 0.5\""));
  const Outcome radiance = of("radiance");
  EXPECT_THAT(radiance.out, HasSubstr("void trans leaf 0 0 7 0.7000 0.7000 0.7000 0 0 0.5714 0"));
}

TEST_F(ExportCommand, TheSameBytesOnAnyNumberOfThreads) {
  for (const char* format : {"radiance", "csv", "npz", "osl", "gltf", "materialx"}) {
    const bool is_color =
        format == std::string("osl") || format == std::string("gltf") || format == std::string("materialx");
    std::vector<std::string> words{
        "leaf_simplified", "--format", format, "-q", "--wavelengths", is_color ? "608,551,455" : "551"};
    if (std::string(format) == "osl") words.insert(words.end(), {"--rays", "1e3"});
    for (const char* threads : {"1", "2"}) {
      auto all = words;
      all.insert(all.end(), {"--threads", threads, "-o", path(threads)});
      ASSERT_EQ(exported(all).code, 0) << format;
    }
    EXPECT_EQ(bytes_of(path("1")), bytes_of(path("2"))) << format;
  }
}

TEST_F(ExportCommand, RefusesTheImpossible) {
  const std::string out = path("a");
  EXPECT_THAT(refusal({"abm", "--format", "radiance", "-o", out}), HasSubstr("abm: its f is a random estimate"));
  EXPECT_THAT(refusal({"conductor", "--format", "csv", "--wavelengths", "551", "-o", out}), HasSubstr("delta lobe"));
  EXPECT_THAT(refusal({"dielectric,roughness=0.3", "--format", "radiance", "-o", out}), HasSubstr("refracts"));
  EXPECT_THAT(refusal({"leaf_solved", "--format", "cvs", "-o", out}),
              HasSubstr("one of mitsuba, radiance, csv, npz, netcdf, osl, gltf, materialx is needed; \"cvs\""));
  EXPECT_THAT(refusal({"leaf_solved", "--format", "csv", "-o", out}), HasSubstr("a table needs wavelengths"));
  EXPECT_THAT(refusal({"leaf_solved", "--format", "csv", "--wavelengths", "551,550", "-o", out}),
              HasSubstr("wavelengths must ascend: 550 follows 551"));
  EXPECT_THAT(refusal({"leaf_solved", "--format", "csv", "--wavelengths", "300", "-o", out}), HasSubstr("360"));
  EXPECT_THAT(refusal({"leaf_solved", "--format", "csv", "--wavelengths", "551", "--angles", "90", "-o", out}),
              HasSubstr("--angles: a list of numbers from 0 to 89.9999 (degrees)"));
  EXPECT_THAT(refusal({"leaf_solved", "--format", "csv", "--wavelengths", "400:2400:0.1", "--view-angles", "0:89:0.1",
                       "-o", out}),
              HasSubstr("a table of"));
  EXPECT_THAT(refusal({"leaf_solved", "--format", "radiance", "--angles", "8", "-o", out}),
              HasSubstr("--angles is for --format csv, npz, netcdf"));
  EXPECT_THAT(refusal({"leaf_solved", "--format", "npz", "--wavelengths", "551", "-o", "-"}), HasSubstr("no text"));
  EXPECT_THAT(refusal({"leaf_solved", "--format", "radiance", "--angles", "8", "--rays", "100", "-o", out}),
              AllOf(HasSubstr("--angles is for --format csv, npz, netcdf"), HasSubstr("--rays is for --format osl")));
  EXPECT_THAT(refusal({"leaf_solved", "--format", "osl", "--wavelengths", "551", "-o", out}),
              HasSubstr("takes three wavelengths"));
  EXPECT_THAT(refusal({"leaf_solved", "--format", "gltf", "--wavelengths", "551", "-o", out}),
              HasSubstr("a colour takes three wavelengths"));
  EXPECT_THAT(refusal({"leaf_solved,incident=light", "--format", "osl", "-o", out}), HasSubstr("incident=light"));
  EXPECT_THAT(refusal({"leaf_solved", "--format", "csv", "--wavelengths", "551", "-o", "/nowhere/a"}),
              HasSubstr("/nowhere"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace frond
