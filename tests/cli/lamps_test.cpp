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

/// A point over a black leaf of 1 m2: energy and photons of each band are shares of those of the lamp.
TEST_F(Lamps, BandsAreInWattsOfTheLampAndByArea) {
  const auto scene =
      folder_.write("leaf.pbrt", std::string("WorldBegin LightSource \"point\" \"spectrum I\" ") + kFlat +
                                     " \"point3 from\" [0 0 1] \"float radiantpower\" 100\n" + kSensor);
  const Outcome outcome =
      frond_command({"flux", scene.string(), "--no-cache", "--bands", "par,red=600:700", "--material", "sensor", "--by",
                     "material", "--paths", "300000", "--json", "-", "-q"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json all = Json::parse(outcome.out);
  const double share = solid_angle_share();
  const auto expect = [](const Json& row, const std::string& name, double expected) {
    EXPECT_NEAR(row[name], expected, 4.5 * row[name + "_se"].get<double>() + 1e-6 * expected) << name;
    EXPECT_LE(row[name + "_se"].get<double>(), 0.01 * expected) << name;
  };
  for (size_t band = 0; band < 2; ++band) {
    const double watts = band == 0 ? 100 : 100.0 / 3, photons = photons_per_watt() * (band == 0 ? 1 : 650.0 / 550);
    expect(all["energy"][band], "w", watts);
    expect(all["energy"][band], "umol_s", watts * photons);
    expect(all["surfaces"][band], "incident_w_m2", watts * share);
    expect(all["surfaces"][band], "absorbed_umol_m2_s", watts * photons * share);
    expect(all["leaves"][band], "incident_w_m2", watts * share);
    const Json organ = all["materials"][0];
    expect(organ, band == 0 ? "par_w_m2" : "red_w_m2", watts * share);
    expect(organ, band == 0 ? "par_incident_umol_m2_s" : "red_incident_umol_m2_s", watts * photons * share);
    EXPECT_TRUE(organ["sunlit_share"].is_null()) << organ;
  }
  EXPECT_NEAR(all["fapar"], share, 0.01);
  EXPECT_FALSE(all.contains("albedo_par"));
}

/// A greenhouse: the light of a lamp and that of a sky, measured together, is the sum of both, and at night the lamp's.
TEST_F(Lamps, UnderASkyAddTheirLight) {
  const std::string lamp = std::string("LightSource \"point\" \"spectrum I\" ") + kFlat +
                           " \"point3 from\" [0 0 1] \"float radiantpower\" 400\n",
                    sky = "LightSource \"sky\" \"float elevation\" 40 \"integer day\" 172\n";
  const auto measured_by = [&](const std::string& lights, std::vector<std::string> words) {
    const auto scene = folder_.write("scene.pbrt", "WorldBegin\n" + lights + kSensor);
    words.insert(words.begin(), {"flux", scene.string(), "--no-cache", "--bands", "par", "--material", "sensor",
                                 "--paths", "200000", "--json", "-", "-q"});
    const Outcome outcome = frond_command(words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Json::parse(outcome.out);
  };
  // Through a target of twice the area of the sensor, half of the light misses it.
  const std::vector<std::string> target{"--target", "-0.5,1.5,-0.5,0.5,1"};
  const Json of_lamp = measured_by(lamp, {}), of_sky = measured_by(sky, target), both = measured_by(lamp + sky, target);
  const auto value = [](const Json& all, const char* table, size_t row, const std::string& name) {
    return std::pair(all[table][row][name].get<double>(), all[table][row][name + "_se"].get<double>());
  };
  const auto expect_sum = [&](const char* table, const std::string& name) {
    const auto [a, a_se] = value(of_lamp, table, 0, name);
    const auto [b, b_se] = value(of_sky, table, 0, name);
    const auto [sum, se] = value(both, table, 0, name);
    EXPECT_NEAR(sum, a + b, 4.5 * std::hypot(a_se, b_se, se)) << table << " " << name;
    EXPECT_LT(se, 0.02 * sum);
  };
  expect_sum("surfaces", "incident_w_m2");
  expect_sum("surfaces", "absorbed_umol_m2_s");
  expect_sum("leaves", "incident_w_m2");
  const double incident = both["energy"][0]["w"];
  EXPECT_NEAR(incident, of_lamp["energy"][0]["w"].get<double>() + 2 * of_sky["energy"][0]["w_m2"].get<double>(),
              1e-3 * incident);
  EXPECT_NEAR(both["energy"][0]["direct_w"], 2 * of_sky["energy"][0]["direct_w_m2"].get<double>(), 1e-3 * incident);
  EXPECT_NEAR(both["leaves"][1]["area"], 1, 1e-6) << "in the sun";

  const auto times = folder_.write("day.csv", "time,elevation\n2026-06-21T12:00,40\n2026-06-21T23:00,-10\n");
  std::vector<std::string> words = target;
  words.insert(words.end(), {"--times", times.string()});
  const Json day = measured_by(lamp + sky, words);
  EXPECT_EQ(value(day, "surfaces", 0, "incident_w_m2"), value(both, "surfaces", 0, "incident_w_m2"));
  EXPECT_EQ(value(day, "surfaces", 1, "incident_w_m2"), value(of_lamp, "surfaces", 0, "incident_w_m2"));
  EXPECT_EQ(value(day, "leaves", 4, "incident_w_m2").first, 0) << "sunlit leaves at night";
  EXPECT_EQ(value(day, "leaves", 5, "incident_w_m2"), value(of_lamp, "leaves", 0, "incident_w_m2"));
  EXPECT_NEAR(day["energy_days"][0]["mj"], (incident + 400) * 39600e-6, 1);
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
  EXPECT_THAT(error(point, {"--target", "0,1,0,1,1"}), HasSubstr("--target: light from outside enters there, and the"));
  EXPECT_THAT(error(point + "\nLightSource \"sky\"", {"--irradiance", "solar-am1.5-global"}),
              HasSubstr("lamps in the scene have their own"));
  const Outcome relative = measured(point, {});
  EXPECT_EQ(relative.code, 0) << relative.err;
  EXPECT_THAT(relative.err, HasSubstr("this light has no unit, so that photons are unknown"));
}

}  // namespace
}  // namespace frond
