#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/command_test.h"

/// The jobs brf and flux as commands; tests/radiometry tests what they measure.
namespace frond {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kSun =
    "LightSource \"distant\" \"point3 from\" [-1 0 2] \"point3 to\" [0 0 0] \"spectrum L\" \"stdillum-E\"\n";
constexpr const char* kSky = "LightSource \"infinite\" \"spectrum L\" \"stdillum-E\"\n";

class RadiometryJobs : public CommandTest {
 protected:
  Outcome measured(const std::string& lights, std::vector<std::string> words) {
    const auto scene =
        folder_.write("scene.pbrt", options_ + "\nWorldBegin\n" + lights +
                                        "Material \"diffuse\" \"spectrum reflectance\" [300 0.3 2500 0.3]\n"
                                        "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n" +
                                        more_);
    words.insert(words.begin() + 1, {scene.string(), "--no-cache"});
    for (const auto& [name, value] : {std::pair{"--paths", "64"}, {"--wavelengths", "550"}})
      if (std::ranges::find(words, name) == words.end()) words.insert(words.end(), {name, value});
    return frond_command(words);
  }

  std::string options_ = "Option \"float period\" [1 1]";
  std::string more_;  ///< of the scene
};

/// Schaepman-Strub et al. 2006: a factor under light of one direction is bidirectional, under sun and sky
/// hemispherical-directional.
TEST_F(RadiometryJobs, TheFactorIsNamedByItsIllumination) {
  const auto check = [this](const std::string& lights, const std::string& name, const std::string& column) {
    const Outcome text = measured(lights, {"brf", "--zenith", "0,30"});
    EXPECT_TRUE(text.out.starts_with(name + "\n")) << text.out << text.err;
    EXPECT_THAT(measured(lights, {"brf", "--zenith", "0", "--csv", "-", "-q"}).out,
                HasSubstr("wavelength_nm," + column + "," + column + "_se\n"));
    const auto json = nlohmann::json::parse(measured(lights, {"brf", "--zenith", "0", "--json", "-", "-q"}).out);
    EXPECT_EQ(json["quantity"], name);
    EXPECT_NEAR(json["brf"][0][column].get<double>(), 0.3, 2e-3);
    EXPECT_EQ(measured(lights, {"brf", "--zenith", "0,30", "--plot", path("plot.svg")}).code, 0);
    std::ifstream plot(path("plot.svg"));
    EXPECT_THAT(std::string(std::istreambuf_iterator<char>(plot), {}), HasSubstr(">" + name + "<"));
  };
  check(kSun, "BRF", "brf");
  check(kSky, "HDRF", "hdrf");
  check(std::string(kSun) + kSky, "HDRF", "hdrf");
  check(std::string(kSun) + "Translate 0 0 0 Rotate 90 0 0 1\n" + kSun, "HDRF", "hdrf");
}

TEST_F(RadiometryJobs, HelpSaysWhetherAnErrorIsAbsoluteOrRelative) {
  EXPECT_THAT(frond_command({"flux", "--help"}).out, HasSubstr("Absolute standard error, as a share of the incident"));
  EXPECT_THAT(frond_command({"brf", "--help"}).out, HasSubstr("Relative standard error"));
}

TEST_F(RadiometryJobs, WavelengthsOfAnImageAreNoBands) {
  for (const char* job : {"brf", "flux"})
    for (const char* wavelengths : {"smpte", "hero", "meyer"}) {
      const Outcome o = measured(kSun, {job, "--wavelengths", wavelengths});
      EXPECT_EQ(o.code, 1);
      EXPECT_THAT(o.err, HasSubstr("a measurement needs bands, as in 608,551,455")) << job << " " << wavelengths;
    }
}

TEST_F(RadiometryJobs, TheTargetLiesInTheScene) {
  options_ = "";
  for (const char* job : {"brf", "flux"}) {
    EXPECT_THAT(measured(kSun, {job, "--target", "0,1e20,0,1e20,1"}).err, HasSubstr("5e+17 units from the origin"));
    EXPECT_THAT(measured(kSun, {job, "--target", "2,3,0,1,0"}).err,
                HasSubstr("the target lies beside the scene, which reaches from (0, 0) to (1, 1)"));
    EXPECT_EQ(measured(kSun, {job, "--target", "0,3,0,1,0"}).code, 0);
  }
  EXPECT_THAT(measured(kSun, {"brf", "--zenith", "-80:80:0.001"}).err, HasSubstr("65536 is the limit"));
}

TEST_F(RadiometryJobs, PhotonsAreCountedInPhysicalUnitsAlone) {
  const std::string par = "400:700:50", sky = "LightSource \"sky\"\n";
  const auto error = [&](const std::string& lights, const std::string& irradiance, const std::string& nm) {
    const Outcome o = measured(lights, {"flux", "--wavelengths", nm, "--irradiance", irradiance, "-q"});
    return o.code == 0 ? "" : o.err;
  };
  EXPECT_EQ(error(sky, "scene", par), "");
  EXPECT_EQ(error(kSun, "solar-am0", par), "");
  EXPECT_THAT(error(kSun, "scene", par),
              HasSubstr("scene.pbrt:3:13: --irradiance scene: this light is scaled to lumi"));
  EXPECT_THAT(error("LightSource \"sky\" \"float illuminance\" 3\n", "scene", par), HasSubstr("scene.pbrt:3:19: "));
  EXPECT_THAT(error(sky, "stdillum-D65", par), HasSubstr("\"stdillum-D65\" is not in W/(m2 nm)"));
  EXPECT_EQ(error(sky, "scene", "550"), "");
  EXPECT_THAT(measured(sky, {"flux", "--irradiance", "scene"}).err,
              HasSubstr("--irradiance has no effect on single wavelengths; no PAR: bands from 400"));
  EXPECT_THAT(measured(kSun, {"flux"}).err, HasSubstr("no PAR: bands from 400"));
  EXPECT_THAT(measured(kSun, {"flux", "--wavelengths", par}).err,
              HasSubstr("; incident PAR 1977.9 µmol/(m2 s), irradiance solar-am1.5-global\n"));
  // A sky has a unit: its photons are not computed from another light.
  EXPECT_EQ(measured(sky, {"flux", "--wavelengths", par, "-q", "--csv", "-"}).out,
            measured(sky, {"flux", "--wavelengths", par, "-q", "--csv", "-", "--irradiance", "scene"}).out);
  EXPECT_THAT(measured(sky, {"flux", "--wavelengths", par}).err, HasSubstr("irradiance scene\n"));
}

/// PAR and green have equal mean wavelengths; names and order follow the files.
TEST_F(RadiometryJobs, BandsHaveNamesInAllOutputs) {
  folder_.write("par.spd", "400 1 700 1");
  folder_.write("green.spd", "540 1 560 1");
  const std::string files = "bands,responses=" + path("par.spd") + "," + path("green.spd");
  const auto run = [&](std::vector<std::string> words, const std::string& names) {
    words.insert(words.end(), {"--wavelengths", files + names});
    return measured(kSun, words);
  };
  EXPECT_THAT(run({"brf", "--zenith", "0"}, "").out, ::testing::ContainsRegex("azimuth +band par +band green\n"));
  EXPECT_THAT(run({"flux"}, ",names=PAR,G").out, ::testing::ContainsRegex("material +band PAR +band G\n"));
  EXPECT_THAT(run({"brf", "--zenith", "0", "--csv", "-", "-q"}, "").out,
              ::testing::ContainsRegex("azimuth_deg,band,wavelength_nm,brf,brf_se\n0,0,par,550,.*\n0,0,green,550,"));
  EXPECT_THAT(run({"flux", "--csv", "-", "-q"}, "").out,
              ::testing::ContainsRegex("quantity,material,band,wavelength_nm,share,share_se\nreflected,,par,550,.*\n"
                                       "reflected,,green,550,"));
  const auto json = nlohmann::json::parse(run({"flux", "--json", "-", "-q"}, ",names=PAR,G").out);
  EXPECT_EQ(json["flux"][0]["band"], "PAR");
  EXPECT_EQ(json["flux"][1]["band"], "G");
  EXPECT_EQ(json["irradiance"], "scene");
  EXPECT_THAT(run({"flux"}, "").err, HasSubstr("bands are weighted by the irradiance scene\n"));
  EXPECT_EQ(run({"brf", "--zenith", "0,30", "--plot", path("plot.svg")}, "").code, 0);
  std::ifstream plot(path("plot.svg"));
  EXPECT_THAT(std::string(std::istreambuf_iterator<char>(plot), {}), HasSubstr(">green<"));
  more_ =
      "ObjectBegin \"leaf\"\nShape \"disk\" \"float radius\" 0.3\nObjectEnd\nTranslate 0.5 0.5 1\n"
      "ObjectInstance \"leaf\"\n";
  EXPECT_THAT(run({"flux", "--by", "instance", "-q"}, "").out,
              HasSubstr("instance,area,absorbed_par,absorbed_par_se,absorbed_green,absorbed_green_se\n"));
}

/// The sun of kSun stands at 26.6 degrees. Bands of very different factors have a panel each, from 0.
TEST_F(RadiometryJobs, TheChartShowsTheSunAndLinearAxes) {
  more_ =
      "Material \"diffuse\" \"spectrum reflectance\" [500 0.02 560 0.02 830 0.5 900 0.5]\n"
      "Shape \"bilinearmesh\" \"point3 P\" [0 0 .1 1 0 .1 0 1 .1 1 1 .1]\n";
  const auto plot = [this](const std::string& wavelengths, const std::string& lights) {
    EXPECT_EQ(
        measured(lights, {"brf", "--zenith=-60:60:30", "--wavelengths", wavelengths, "--plot", path("plot.svg")}).code,
        0);
    std::ifstream file(path("plot.svg"));
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string two = plot("550,841.294", kSun);
  EXPECT_THAT(two, ::testing::AllOf(HasSubstr(">550 nm<"), HasSubstr(">841 nm<"), HasSubstr(">sun<"),
                                    HasSubstr(">view zenith angle (degrees), negative: sun’s side<"),
                                    HasSubstr("clipPath id='p1'"), HasSubstr(">0.01<"), HasSubstr(">0.4<")));
  const std::string near = plot("550.2,550.4", kSun);
  EXPECT_THAT(near, ::testing::AllOf(HasSubstr(">550.2 nm<"), HasSubstr(">550.4 nm<"), Not(HasSubstr("id='p1'"))));
  EXPECT_THAT(plot("550", kSky), ::testing::AllOf(Not(HasSubstr(">sun<")), Not(HasSubstr("negative"))));
}

TEST_F(RadiometryJobs, WavelengthsKeepTheirOrder) {
  EXPECT_THAT(measured(kSun, {"flux", "--wavelengths", "700,400"}).out, ::testing::ContainsRegex("700 nm +400 nm\n"));
  EXPECT_THAT(measured(kSun, {"brf", "--zenith", "0", "--wavelengths", "700,400", "--csv", "-", "-q"}).out,
              ::testing::ContainsRegex("\n0,0,700,.*\n0,0,400,"));
  EXPECT_THAT(measured(kSun, {"flux", "--wavelengths", "700,650,600,550,500,450,400"}).err,
              HasSubstr("incident PAR 1977.9"));
}

/// The results of these commands are printed, or written, or lost.
TEST_F(RadiometryJobs, AResultThatIsNotKeptIsAWarning) {
  const std::string warning = "-q prints no result", lost = "nothing is kept; --csv or --json";
  for (const char* command : {"brf", "flux"}) {
    const Outcome o = measured(kSun, {command, "-q"});
    EXPECT_EQ(o.code, 0);
    EXPECT_EQ(o.out, "");
    EXPECT_THAT(o.err, HasSubstr(lost)) << command;
    EXPECT_EQ(measured(kSun, {command, "-q", "--csv", path("a.csv")}).err, "");
    EXPECT_EQ(measured(kSun, {command, "-q", "--json", "-"}).err, "");
  }
  for (const char* command : {"spectrophotometer", "goniophotometer"})
    EXPECT_THAT(frond_command({command, "diffuse", "--wavelengths", "551", "--rays", "1e3", "-q"}).err,
                HasSubstr(lost));
  more_ =
      "ObjectBegin \"leaf\"\nShape \"disk\" \"float radius\" 0.3\nObjectEnd\nTranslate 0.5 0.5 1\n"
      "ObjectInstance \"leaf\"\n";
  EXPECT_THAT(measured(kSun, {"flux", "--by", "instance", "-q"}).err, Not(HasSubstr(lost)));  // is printed
}

/// A leaf of 1 over a ground of 2000.
TEST_F(RadiometryJobs, ATargetOfEmptyGroundIsAWarningWithABetterOne) {
  options_.clear();
  more_ =
      "Shape \"disk\" \"float radius\" 1000 \"float height\" -1\n"
      "MakeNamedMaterial \"leaf\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0 2500 0]\n"
      "NamedMaterial \"leaf\"\nShape \"bilinearmesh\" \"point3 P\" [0 0 1 1 0 1 0 1 1 1 1 1]\n";
  const std::string instead = "--target 0,1,0,1,1";
  for (const char* command : {"brf", "flux"}) {
    EXPECT_THAT(measured(kSun, {command}).err, HasSubstr("covers 2.5e-05 % of it: " + instead)) << command;
    EXPECT_THAT(measured(kSun, {command, "--target", "0,1,0,1,1"}).err, Not(HasSubstr("the target is the whole")));
  }
  const Outcome all = measured(kSun, {"flux"});
  EXPECT_THAT(all.err, HasSubstr("no path met the material \"leaf\": its shares are unknown; raise --paths, or give a "
                                 "smaller --target"));
  EXPECT_THAT(all.out, ::testing::ContainsRegex("absorbed +leaf +0\n"));
  EXPECT_THAT(measured(kSun, {"flux", "--csv", "-", "-q"}).out, HasSubstr("absorbed,leaf,550,0,\n"));
  const Outcome leaf = measured(kSun, {"flux", "--target", "0,1,0,1,1"});
  EXPECT_THAT(leaf.err, Not(HasSubstr("no path met the material \"leaf\"")));
  EXPECT_THAT(leaf.out, ::testing::ContainsRegex("absorbed +leaf +1\n"));
}

/// No row and no warning for surfaces without a material, for objects that are not placed, for materials of mixtures.
TEST_F(RadiometryJobs, OnlyMaterialsOfSurfacesCanBeMet) {
  more_ =
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\n"
      "MakeNamedMaterial \"b\" \"string type\" \"mix\" \"string materials\" [\"a\" \"a\"]\n"
      "NamedMaterial \"b\" Shape \"bilinearmesh\" \"point3 P\" [0 0 1 1 0 1 0 1 1 1 1 1]\n"
      "Material \"interface\" Shape \"bilinearmesh\" \"point3 P\" [0 0 2 1 0 2 0 1 2 1 1 2]\n"
      "MakeNamedMaterial \"c\" \"string type\" \"diffuse\" NamedMaterial \"c\"\n"
      "ObjectBegin \"unused\" Shape \"disk\" ObjectEnd\n";
  const Outcome o = measured(kSun, {"flux"});
  EXPECT_THAT(o.err, HasSubstr("no path met the material \"diffuse\": its shares are unknown"));  // below
  EXPECT_THAT(o.out, ::testing::ContainsRegex("absorbed +b +"));
  EXPECT_THAT(o.out, Not(::testing::ContainsRegex("absorbed +(a|c|interface) +")));
}

TEST_F(RadiometryJobs, AnErrorIsEstimatedFromSeveralPaths) {
  EXPECT_THAT(measured(kSun, {"flux", "--wavelengths", "550,670", "--paths", "1"}).err, HasSubstr("64 paths; RMS"));
}

/// One of the two leaves is too small to be hit by a path.
TEST_F(RadiometryJobs, TheErrorOfAnInstanceWithoutLightIsUnknown) {
  more_ =
      "ObjectBegin \"leaf\"\nShape \"disk\" \"float radius\" 0.3\nObjectEnd\n"
      "Translate 0.5 0.5 1\nObjectInstance \"leaf\"\nScale 1e-6 1e-6 1e-6\nObjectInstance \"leaf\"\n";
  const Outcome o = measured(kSun, {"flux", "--by", "instance"});
  EXPECT_THAT(o.err, HasSubstr("1 of 2 instances met no light path, or absorb none: their errors are unknown"));
  EXPECT_THAT(o.out, ::testing::ContainsRegex("\n +2  2.82743e-13 +0\n"));
  EXPECT_TRUE(measured(kSun, {"flux", "--by", "instance", "-q"}).out.ends_with(",0,\n"));
}

/// Ten leaves of one hundredth of the target each: of 2000 paths about 20 meet a leaf, which absorbs 0.7 of the light.
class RadiometryByInstance : public RadiometryJobs {
 protected:
  RadiometryByInstance() {
    more_ = "ObjectBegin \"leaf\"\nShape \"bilinearmesh\" \"point3 P\" [0 0 0 .1 0 0 0 .1 0 .1 .1 0]\nObjectEnd\n";
    for (int i = 0; i < 10; ++i)
      more_ += fmt::format("{}ObjectInstance \"leaf\"\n", i ? "Translate .1 0 0\n" : "Translate 0 .5 1\n");
  }
  std::string content(const std::string& name) {
    std::ifstream file(path(name));
    return {std::istreambuf_iterator<char>(file), {}};
  }
};

/// 1 / sqrt(20) is 22 %, the error of independent paths.
TEST_F(RadiometryByInstance, TheErrorsOfSingleInstancesAreStated) {
  const Outcome few = measured(kSun, {"flux", "--by", "instance", "--paths", "2000", "--json", "-"});
  EXPECT_THAT(few.err, ::testing::ContainsRegex("RMS standard error 0.0[0-9]+\n"));
  EXPECT_THAT(few.err,
              ::testing::ContainsRegex(
                  "warning: relative standard error of the light at 550 nm that single instances absorb: median "
                  "1[2-9] %, largest [12][0-9] %; --instance-error 0.05 continues until the median is "
                  "5 %, which takes about [1-3][.0-9]*e.04 paths\n"));
  const auto json = nlohmann::json::parse(few.out);
  const double median = json["instance_error_median"], largest = json["instance_error_largest"];
  std::vector<double> errors;
  for (const auto& leaf : json["instances"])
    errors.push_back(leaf["absorbed_550_se"].get<double>() / leaf["absorbed_550"].get<double>());
  std::ranges::sort(errors);
  EXPECT_DOUBLE_EQ(median, errors[5]);
  EXPECT_DOUBLE_EQ(largest, errors[9]);
  const Outcome many = measured(kSun, {"flux", "--by", "instance", "--paths", "40000", "--json", "-"});
  EXPECT_THAT(many.err,
              ::testing::ContainsRegex("\nrelative standard error of the light at 550 nm that single instances "
                                       "absorb: median [12].[0-9] %, largest"));
  EXPECT_THAT(measured(kSun, {"flux", "--by", "instance", "--paths", "40000", "--json", "-", "-q"}).err, "");
}

TEST_F(RadiometryByInstance, ContinuesUntilTheMedianErrorIsReached) {
  const auto median = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"flux", "--by", "instance", "--json", "-", "-q"});
    const Outcome o = measured(kSun, words);
    EXPECT_EQ(o.err, "");
    const auto json = nlohmann::json::parse(o.out);
    return std::pair{json["instance_error_median"].get<double>(), json["paths"].get<double>()};
  };
  EXPECT_EQ(median({"--instance-error", "0.05"}).second, 65536);
  const auto [reached, paths] = median({"--instance-error", "1%"});
  EXPECT_LT(reached, 0.01);
  EXPECT_GT(reached, 0.009);  // of an eighth less paths it is above 1 %
  EXPECT_GT(paths, 1 << 16);
  EXPECT_LT(paths, 1 << 17);
  EXPECT_GT(median({"--instance-error", "0.05", "--rms", "0.00009"}).second, 1 << 19);  // both
  EXPECT_THAT(measured(kSun, {"flux", "--instance-error", "0.05"}).err, HasSubstr("--instance-error needs --by"));
  EXPECT_THAT(measured(kSun, {"flux", "--by", "instance", "--instance-error", "5"}).err,
              HasSubstr("--instance-error: a number above 0, up to 1, or a share in percent, as in 2%,"));
}

TEST_F(RadiometryByInstance, AnErrorThatCannotBeReachedEnds) {
  const Outcome late = measured(
      kSun, {"flux", "--by", "instance", "--instance-error", "1e-6", "--time-limit", "0.3", "--csv", "-", "-q"});
  EXPECT_EQ(late.code, 0);
  EXPECT_THAT(late.err,
              HasSubstr("--instance-error 1e-06 was not reached; relative standard error of the light at 550"));
  EXPECT_THAT(late.err, Not(HasSubstr("paths were traced, not")));
  more_ = "Material \"diffuse\" \"spectrum reflectance\" [300 1 2500 1]\n" + more_;  // absorb nothing
  EXPECT_THAT(measured(kSun, {"flux", "--by", "instance", "--instance-error", "0.05"}).err,
              HasSubstr("--instance-error: the instances absorb no light, of 65536 paths: there is no error to reach"));
}

/// --csv writes both tables or none.
TEST_F(RadiometryByInstance, BothTablesAreKept) {
  const std::vector<std::string> command{"flux", "--by", "instance", "--csv", path("leaves.csv")};
  const Outcome o = measured(kSun, command);
  EXPECT_THAT(o.out, ::testing::MatchesRegex("        share +material +550 nm\n +reflected(.|\n)*"));
  EXPECT_THAT(o.out, Not(HasSubstr("instance")));  // is in the file
  EXPECT_TRUE(content("leaves.csv").starts_with("instance,area,absorbed_550,absorbed_550_se\n1,0.01"))
      << content("leaves.csv");
  const std::string shares = content("leaves-flux.csv");
  EXPECT_TRUE(shares.starts_with("quantity,material,wavelength_nm,share,share_se\nreflected,,550,0.")) << shares;
  EXPECT_EQ(shares, measured(kSun, {"flux", "--csv", "-", "-q"}).out);
  const Outcome printed = measured(kSun, {"flux", "--by", "instance", "--paths", "2000"});
  EXPECT_THAT(printed.out,
              ::testing::ContainsRegex("uncollided +.*\n\n  instance +area +absorbed_550\n +1 +0.01 +0.0"));

  std::filesystem::remove(path("leaves.csv"));
  std::filesystem::remove(path("leaves-flux.csv"));
  std::filesystem::create_directory(path("leaves-flux.csv"));
  EXPECT_THAT(measured(kSun, command).err, HasSubstr("leaves-flux.csv\": it is a folder"));
  EXPECT_FALSE(std::filesystem::exists(path("leaves.csv")));
}

TEST_F(RadiometryByInstance, TheFileBesideIsNoOtherFile) {
  const auto csv = [&](const std::string& name, const Words& more) {
    return measured(kSun, joined({"flux", "--by", "instance", "--csv", path(name)}, more)).err;
  };
  EXPECT_THAT(csv("leaves.csv", {"--json", path("leaves-flux.csv")}),
              HasSubstr("--json and the table of shares beside --csv write to the same file"));
  folder_.write("sun-flux.spd", "300 1\n2500 1\n");
  EXPECT_THAT(csv("sun.spd", {"--irradiance", path("sun-flux.spd"), "--wavelengths", "400:700:50"}),
              HasSubstr("the table of shares beside --csv would replace the input"));
  EXPECT_EQ(content("sun-flux.spd"), "300 1\n2500 1\n");
}

TEST_F(RadiometryJobs, AnErrorNamesTheLight) {
  options_.clear();
  const std::string lamp = "LightSource \"point\"\n";
  EXPECT_THAT(measured(kSun + lamp, {"brf"}).err, HasSubstr("scene.pbrt:4:13: brf needs lights outside the scene"));
  for (const char* command : {"brf", "flux"}) {
    EXPECT_THAT(measured("Rotate 180 1 0 0\n" + std::string(kSun), {command}).err,
                HasSubstr("scene.pbrt:4:13: no light falls on the scene from above, from +z, at 550 nm"));
  }
}

TEST_F(RadiometryJobs, OptionsOfAComparisonNeedOne) {
  EXPECT_THAT(measured(kSun, {"brf", "--reference", "abm"}).err, HasSubstr("--reference needs --compare"));
  EXPECT_THAT(measured(kSun, {"brf", "--within", "0.1"}).err, HasSubstr("--within needs --compare"));
}

}  // namespace
}  // namespace frond
