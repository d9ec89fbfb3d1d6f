#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/cli/command.h"
#include "tests/support/input_error.h"

/// The jobs brf and flux as commands; tests/radiometry tests what they measure.
namespace frond {
namespace {

using ::testing::HasSubstr;

constexpr const char* kSun =
    "LightSource \"distant\" \"point3 from\" [-1 0 2] \"point3 to\" [0 0 0] \"spectrum L\" \"stdillum-E\"\n";
constexpr const char* kSky = "LightSource \"infinite\" \"spectrum L\" \"stdillum-E\"\n";

class RadiometryJobs : public ::testing::Test {
 protected:
  Outcome measured(const std::string& lights, std::vector<std::string> words) {
    const auto scene =
        folder_.write("scene.pbrt", "Option \"float period\" [1 1]\nWorldBegin\n" + lights +
                                        "Material \"diffuse\" \"spectrum reflectance\" [300 0.3 2500 0.3]\n"
                                        "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]\n");
    words.insert(words.begin() + 1, {scene.string(), "--no-cache", "--paths", "64", "--wavelengths", "550"});
    return frond_command(words);
  }

  TestFolder folder_{"radiometry_jobs"};
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
    EXPECT_EQ(measured(lights, {"brf", "--zenith", "0,30", "--plot", folder_.name_of("plot.svg")}).code, 0);
    std::ifstream plot(folder_.name_of("plot.svg"));
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

}  // namespace
}  // namespace frond
