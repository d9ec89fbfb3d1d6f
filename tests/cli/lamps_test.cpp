#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/support/command_test.h"

/// `frond flux` under lamps in the scene.
namespace frond {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

using Json = nlohmann::json;

constexpr double kPiD = std::numbers::pi;
/// A black square of 1 m2 at z = 0 below a lamp at the height 1, with a constant spectrum from 400 to 700 nm: photons
/// and energy are closed forms.
constexpr const char* kSensor =
    "MakeNamedMaterial \"sensor\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0 2500 0]\n"
    "NamedMaterial \"sensor\" Shape \"bilinearmesh\" \"point3 P\" [-0.5 -0.5 0  0.5 -0.5 0  -0.5 0.5 0  0.5 0.5 0]\n";
constexpr const char* kFlat = "[400 1 700 1]";

class Lamps : public CommandTest {
 protected:
  Outcome measured(const std::string& lamp, std::vector<std::string> words) {
    const auto scene = folder_.write("scene.pbrt", "WorldBegin\n" + lamp + "\n" + kSensor);
    words.insert(words.begin(),
                 {"flux", scene.string(), "--no-cache", "--paths", "1200000", "--wavelengths", "400:700:50"});
    return frond_command(words);
  }
  /// The row of the sensor in the table of surfaces.
  Json sensor(const std::string& lamp) {
    const Outcome outcome = measured(lamp, {"--json", "-", "-q"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const Json all = Json::parse(outcome.out);
    for (const Json& row : all["surfaces"])
      if (row["material"] == "sensor") {
        Json found = row;
        found["lamps"] = all["par_umol_s"];
        return found;
      }
    ADD_FAILURE() << outcome.out;
    return {};
  }
};

/// Photons of 1 W of a spectrum that is constant from 400 to 700 nm, umol: the mean wavelength over h c N.
double photons_per_watt() { return 550 / (6.62607015e-34 * 299792458 * 6.02214076e23 * 1e9 * 1e-6); }

/// Share of an isotropic point's light that falls on the square: its solid angle over 4 pi.
double solid_angle_share() { return 4 * std::asin(0.25 / 1.25) / (4 * kPiD); }

// Each comparison allows 4.5 standard errors: a false alarm of 7e-6 each.
void expect_photons(const Json& row, double expected) {
  EXPECT_NEAR(row["incident_umol_m2_s"], expected, 4.5 * row["incident_umol_m2_s_se"].get<double>());
  EXPECT_LT(row["incident_umol_m2_s_se"].get<double>(), 0.005 * expected);
  EXPECT_EQ(row["incident_umol_m2_s"], row["absorbed_umol_m2_s"]);
  EXPECT_NEAR(row["area"], 1, 1e-6);
}

TEST_F(Lamps, APointOfKnownPowerOverAPlane) {
  const Json watts = sensor(std::string("LightSource \"point\" \"spectrum I\" ") + kFlat +
                            " \"point3 from\" [0 0 1] \"float radiantpower\" 100");
  EXPECT_NEAR(watts["lamps"], 100 * photons_per_watt(), 1e-3);
  expect_photons(watts, 100 * photons_per_watt() * solid_angle_share());
  const Json photons = sensor(std::string("LightSource \"point\" \"spectrum I\" ") + kFlat +
                              " \"point3 from\" [0 0 1] \"float photonflux\" 250");
  EXPECT_NEAR(photons["lamps"], 250, 1e-3);
  expect_photons(photons, 250 * solid_angle_share());
}

/// Lambertian squares that face each other, equal and at a distance of their side: form factor 0.19982 (Howell's
/// catalogue, C-11).
TEST_F(Lamps, AnAreaLightOfKnownPowerOverAPlane) {
  constexpr double kFormFactor = 0.199825;
  const std::string square = " Shape \"bilinearmesh\" \"point3 P\" [-0.5 -0.5 1  -0.5 0.5 1  0.5 -0.5 1  0.5 0.5 1]\n";
  const std::string lamp = std::string("AreaLightSource \"diffuse\" \"spectrum L\" ") + kFlat;
  const std::string black =
      "MakeNamedMaterial \"lamp\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0 2500 0]\nNamedMaterial "
      "\"lamp\" ";
  expect_photons(sensor("AttributeBegin " + black + lamp + " \"float radiantpower\" 40" + square + "AttributeEnd"),
                 40 * photons_per_watt() * kFormFactor);
  expect_photons(sensor("AttributeBegin " + black + lamp + " \"bool twosided\" true \"float photonflux\" 500" + square +
                        "AttributeEnd"),
                 250 * kFormFactor);
  // Two triangles are one lamp, not one each.
  expect_photons(
      sensor("AttributeBegin " + black + lamp +
             " \"float photonflux\" 500 Shape \"trianglemesh\" \"integer indices\" [0 2 1 0 3 2] \"point3 P\" "
             "[-0.5 -0.5 1  0.5 -0.5 1  0.5 0.5 1  -0.5 0.5 1] AttributeEnd"),
      500 * kFormFactor);
}

/// A spot whose inner and outer cones are nearly equal: all of its light falls on the square, or a known part.
TEST_F(Lamps, ASpotAndTwoLamps) {
  const std::string spot = std::string("LightSource \"spot\" \"spectrum I\" ") + kFlat +
                           " \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"float coneangle\" 20 "
                           "\"float photonflux\" 30";
  const Json one = sensor(spot);
  EXPECT_NEAR(one["incident_umol_m2_s"], 30, 4.5 * one["incident_umol_m2_s_se"].get<double>() + 3e-3);
  const Json two = sensor(spot + "\nLightSource \"point\" \"spectrum I\" " + kFlat +
                          " \"point3 from\" [0 0 1] \"float photonflux\" 250");
  EXPECT_NEAR(two["lamps"], 280, 0.02);
  expect_photons(two, 30 + 250 * solid_angle_share());
}

TEST_F(Lamps, SharesAreOfTheLampsPower) {
  const Outcome text = measured(std::string("LightSource \"point\" \"spectrum I\" ") + kFlat +
                                    " \"point3 from\" [0 0 1] \"float photonflux\" 250",
                                {});
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("incident_umol_m2_s"));
  EXPECT_THAT(text.err, HasSubstr("PAR of the lamps 250 µmol/s"));
}

TEST_F(Lamps, BadLampsAreErrors) {
  const auto error = [this](const std::string& lamp, std::vector<std::string> words = {}) {
    const Outcome outcome = measured(lamp, words);
    EXPECT_EQ(outcome.code, 1) << lamp;
    return outcome.err;
  };
  const std::string point = std::string("LightSource \"point\" \"spectrum I\" ") + kFlat + " \"point3 from\" [0 0 1] ";
  EXPECT_THAT(error(point + "\"float radiantpower\" 1 \"float photonflux\" 1"), HasSubstr("exclude each other"));
  EXPECT_THAT(error(point + "\"float power\" 1 \"float photonflux\" 1"), HasSubstr("exclude each other"));
  EXPECT_THAT(error(point + "\"float photonflux\" -1"), HasSubstr("outside its range"));
  EXPECT_THAT(error("LightSource \"point\" \"spectrum I\" [300 0 710 0 720 1 800 1] \"float photonflux\" 1"),
              HasSubstr("the spectrum has no light from 400 to 700 nm"));
  EXPECT_THAT(error(point + "\nLightSource \"distant\""), HasSubstr("not both together"));
  EXPECT_THAT(error(point, {"--target", "0,1,0,1,1"}), HasSubstr("lamps in the scene need none"));
  const Outcome relative = measured(point, {});
  EXPECT_EQ(relative.code, 0) << relative.err;
  EXPECT_THAT(relative.err, HasSubstr("this light has no unit, so that photons are unknown"));
}

}  // namespace
}  // namespace frond
