// Light budgets by energy and photons, by direct and diffuse light and by organ, against closed forms.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radiometry/flux.h"
#include "scene/format/parser.h"
#include "spectra/named.h"
#include "spectra/spectrl2.h"
#include "spectra/tabulated.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::HasSubstr;

// Each comparison allows 4.5 standard errors: a false alarm of 7e-6 each, below 2e-3 for all of this file. Seeds are
// fixed.
constexpr double kZ = 4.5;
constexpr double kPiD = std::numbers::pi;

/// Function of wavelength that is linear between points.
using Line = std::vector<std::pair<double, double>>;

double at(const Line& line, double nm) {
  for (size_t i = 1; i < line.size(); ++i)
    if (nm <= line[i].first)
      return std::lerp(line[i - 1].second, line[i].second,
                       (nm - line[i - 1].first) / (line[i].first - line[i - 1].first));
  return line.back().second;
}

std::string text_of(const Line& line) {
  std::string text = "[";
  for (const auto& [nm, value] : line) text += fmt::format(" {} {}", nm, value);
  return text + " ]";
}

/// Reflectance and transmittance of a leaf, roughly, and reflectance of a soil.
const Line kR{{300, 0.05}, {500, 0.05}, {550, 0.13}, {680, 0.05}, {740, 0.45}, {1300, 0.45}, {1450, 0.2}, {2500, 0.05}},
    kT{{300, 0.01}, {500, 0.02}, {550, 0.12}, {680, 0.03}, {740, 0.43}, {1300, 0.44}, {1450, 0.2}, {2500, 0.04}},
    kSoil{{300, 0.05}, {700, 0.2}, {2500, 0.45}};

/// By midpoints of 0.05 nm.
template <class Function>
double integral(double from, double to, const Function& f) {
  constexpr double kStep = 0.05;
  double sum = 0;
  for (double nm = from + kStep / 2; nm < to; nm += kStep) sum += f(nm) * kStep;
  return sum;
}

/// Planck constant times speed of light times Avogadro constant, J nm / umol.
constexpr double kHcN = 119.626565817;

struct Range {
  const char* name;
  double from, to;
};
constexpr Range kBands[] = {{"par", 400, 700}, {"nir", 700, 1100}, {"shortwave", 300, 2500}};
const std::string kBandsText = "bands,ranges=400,700,700,1100,300,2500,names=par,nir,shortwave";

class Energy : public ::testing::Test {
 protected:
  FluxMeasurement flux(const std::string& world, FluxRequest request, uint64_t paths,
                       const std::string& options = "") const {
    Session session(silent_log(), {2, {}, {}});
    request.energy = true;
    FluxMeter meter(session, parse_scene_text(options + "WorldBegin\n" + world, "t", silent_log()), request);
    meter.trace(paths, session.pool());
    return meter.read();
  }
};

const std::string kTwoPlanes =
    "MakeNamedMaterial \"leaf\" \"string type\" \"diffusetransmission\" \"spectrum reflectance\" " + text_of(kR) +
    " \"spectrum transmittance\" " + text_of(kT) +
    "\nMakeNamedMaterial \"soil\" \"string type\" \"diffuse\" \"spectrum reflectance\" " + text_of(kSoil) +
    "\nNamedMaterial \"leaf\" Shape \"bilinearmesh\" \"point3 P\" [0 0 1  1 0 1  0 1 1  1 1 1]\n"
    "NamedMaterial \"soil\" Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0]\n";

/// The doubling equations of a leaf over a soil, both Lambertian, at a wavelength.
double reflected(double nm) {
  return at(kR, nm) + at(kT, nm) * at(kT, nm) * at(kSoil, nm) / (1 - at(kR, nm) * at(kSoil, nm));
}
double on_soil(double nm) { return at(kT, nm) / (1 - at(kR, nm) * at(kSoil, nm)); }
double in_leaf(double nm) { return (1 - at(kR, nm) - at(kT, nm)) * (1 + on_soil(nm) * at(kSoil, nm)); }

/// Compares a measured share, in units of the light, with an integral.
void expect_light(const MeanError& share, double light, double expected, const char* what) {
  constexpr double kMost = 0.005;  // of the value
  EXPECT_NEAR(share.mean * light, expected, kZ * share.standard_error * light + 3e-4 * expected) << what;
  EXPECT_LT(2 * share.standard_error * light, kMost * expected) << what << ": the test has lost its power";
}

template <class Light>
void expect_two_planes(const FluxMeasurement& m, const Light& light) {
  const EnergyBudget& e = *m.energy;
  ASSERT_EQ(e.incident.size(), 3u);
  ASSERT_EQ(e.materials[0].name, "leaf");
  ASSERT_EQ(e.materials[1].name, "soil");
  for (size_t b = 0; b < 3; ++b) {
    SCOPED_TRACE(kBands[b].name);
    const auto [name, from, to] = kBands[b];
    const auto energy = [&](const auto& share) {
      return integral(from, to, [&](double nm) { return light(nm) * share(nm); });
    };
    const auto photons = [&](const auto& share) {
      return integral(from, to, [&](double nm) { return light(nm) * share(nm) * nm / kHcN; });
    };
    const auto one = [](double) { return 1.0; };
    const IncidentBand& in = e.incident[b];
    EXPECT_NEAR(in.energy.total, energy(one), 3e-4 * energy(one));
    EXPECT_NEAR(in.photons.total, photons(one), 3e-4 * photons(one));
    const auto expect = [&](const EnergyShare& share, const auto& expected, const char* what) {
      expect_light(share.energy.total, in.energy.total, energy(expected), what);
      expect_light(share.photons.total, in.photons.total, photons(expected), what);
    };
    expect(e.reflected[b], reflected, "reflected");
    expect(e.materials[0].absorbed[b], in_leaf, "absorbed by the leaf");
    expect(e.leaves.absorbed[b], in_leaf, "absorbed by leaves");
    expect(e.materials[1].incident[b], on_soil, "incident on the soil");
    expect(
        e.materials[1].absorbed[b], [](double nm) { return on_soil(nm) * (1 - at(kSoil, nm)); }, "soil");
  }
}

const std::string kPeriodic = "Option \"float period\" [1 1]\n";
const std::string kSunOfG173 =
    "LightSource \"distant\" \"point3 from\" [-1 0 2] \"point3 to\" [0 0 0] \"spectrum L\" \"solar-am1.5-global\"\n";

TEST_F(Energy, OfTwoPlanesUnderG173IsThatOfTheDoublingEquations) {
  const SpectrumPtr solar = named_spectrum("solar-am1.5-global", {});
  const FluxMeasurement m = flux(
      kSunOfG173 + kTwoPlanes,
      {.wavelengths = kBandsText, .irradiance = solar, .irradiance_name = "solar-am1.5-global", .leaves = {"leaf"}},
      1 << 21, kPeriodic);
  expect_two_planes(m, [&](double nm) { return double(solar->at(float(nm))); });
  for (size_t b = 0; b < 3; ++b) {
    EXPECT_NEAR(m.energy->incident[b].energy.direct, m.energy->incident[b].energy.total, 1e-6);
    EXPECT_EQ(m.energy->reflected[b].energy.diffuse.mean, 0);
  }
  EXPECT_NEAR(m.energy->incident[2].energy.total, 992.6, 0.1);  // G173 up to 2500 nm
}

/// The energy of direct and of diffuse light is SPECTRL2's. A Lambertian scene reflects both alike.
TEST_F(Energy, OfTwoPlanesUnderSunAndSkyIsThatOfSpectrl2) {
  constexpr double kElevation = 35, kSine = 0.573576436;
  const ClearSkyIrradiance clear = spectrl2({.sun_zenith_deg = 90 - kElevation,
                                             .aerosol = 0.1,
                                             .angstrom = 1.14,
                                             .water_cm = 1.42,
                                             .ozone_atm_cm = 0.31,
                                             .pressure_Pa = 101325,
                                             .albedo = 0,
                                             .day = 172});
  Line direct, total;
  for (size_t i = 0; i < clear.nm.size(); ++i) {
    direct.push_back({clear.nm[i], clear.direct_normal[i] * kSine});
    total.push_back({clear.nm[i], clear.direct_normal[i] * kSine + clear.diffuse[i]});
  }
  const FluxMeasurement m =
      flux(fmt::format("LightSource \"sky\" \"float elevation\" {} \"float azimuth\" 20\n", kElevation) + kTwoPlanes,
           {.wavelengths = kBandsText, .leaves = {"leaf"}}, 1 << 21, kPeriodic);
  expect_two_planes(m, [&](double nm) { return at(total, nm); });
  for (size_t b = 0; b < 3; ++b) {
    SCOPED_TRACE(kBands[b].name);
    const IncidentBand& in = m.energy->incident[b];
    const auto [name, from, to] = kBands[b];
    const double energy = integral(from, to, [&](double nm) { return at(direct, nm); }),
                 photons = integral(from, to, [&](double nm) { return at(direct, nm) * nm / kHcN; });
    EXPECT_NEAR(in.energy.direct, energy, 5e-4 * energy);
    EXPECT_NEAR(in.photons.direct, photons, 5e-4 * photons);
    const LightParts& r = m.energy->reflected[b].energy;
    EXPECT_NEAR(r.direct.mean + r.diffuse.mean, r.total.mean, 1e-12);
    EXPECT_LE(r.total.standard_error, std::hypot(r.direct.standard_error, r.diffuse.standard_error));
    expect_light(r.direct, in.energy.total,
                 integral(from, to, [&](double nm) { return at(direct, nm) * reflected(nm); }),
                 "reflected direct light");
    expect_light(
        m.energy->leaves.absorbed[b].photons.diffuse, in.photons.total,
        integral(from, to, [&](double nm) { return (at(total, nm) - at(direct, nm)) * in_leaf(nm) * nm / kHcN; }),
        "diffuse photons in the leaf");
  }
}

/// A black leaf, half of which is in the shade of a black roof: 0.7 of 2 units, whatever the angle of the sun.
TEST_F(Energy, TheSunlitLeafAreaUnderARoofReceivesTheDirectLight) {
  const std::string world =
      "MakeNamedMaterial \"leaf\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0 2500 0]\n"
      "MakeNamedMaterial \"roof\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0 2500 0]\n"
      "NamedMaterial \"leaf\" Shape \"bilinearmesh\" \"point3 P\" [0 0 0  2 0 0  0 2 0  2 2 0]\n"
      "NamedMaterial \"roof\" Shape \"bilinearmesh\" \"point3 P\" [0 0 1  0.7 0 1  0 2 1  0.7 2 1]\n";
  const FluxMeasurement m = flux("LightSource \"sky\" \"float elevation\" 40 \"float azimuth\" 10\n" + world,
                                 {.wavelengths = "bands,ranges=400,700,names=par", .leaves = {"leaf"}}, 1 << 19,
                                 "Option \"float period\" [2 2]\n");
  const EnergyBudget& e = *m.energy;
  EXPECT_EQ(e.leaf_area.all.mean, 4);
  EXPECT_NEAR(e.leaf_area.sunlit.mean, 2.6, kZ * e.leaf_area.sunlit.standard_error);
  EXPECT_NEAR(e.leaf_area.shaded.mean, 1.4, kZ * e.leaf_area.shaded.standard_error);
  EXPECT_LT(2 * e.leaf_area.sunlit.standard_error, 0.005 * 2.6);
  const double direct = e.incident[0].energy.direct / e.incident[0].energy.total;
  const LightParts &sunlit = e.sunlit.absorbed[0].energy, &shaded = e.shaded.absorbed[0].energy;
  // The penumbra, 0.0093 units high over the roof's distance, changes sides only: 0.5 %.
  EXPECT_NEAR(sunlit.direct.mean, direct * 0.65, kZ * sunlit.direct.standard_error + 0.005 * direct);
  EXPECT_LT(shaded.direct.mean, 0.005 * direct);
  EXPECT_GT(shaded.diffuse.mean, 0);
  EXPECT_NEAR(sunlit.total.mean + shaded.total.mean, e.leaves.absorbed[0].energy.total.mean, 1e-12);
  EXPECT_NEAR(e.leaves.absorbed[0].energy.total.mean, e.materials[0].absorbed[0].energy.total.mean, 1e-12);
}

TEST_F(Energy, OfLeavesWithoutASunOrLeavesIsNotInvented) {
  const std::string overcast = "LightSource \"sky\" \"string sky\" \"overcast\"\n";
  const FluxMeasurement none = flux(overcast + kTwoPlanes, {.wavelengths = kBandsText}, 4096, kPeriodic);
  EXPECT_TRUE(none.energy->leaves.absorbed.empty());
  EXPECT_EQ(none.energy->incident[0].energy.direct, 0);
  const FluxMeasurement all =
      flux(overcast + kTwoPlanes, {.wavelengths = kBandsText, .leaves = {"leaf"}}, 4096, kPeriodic);
  EXPECT_EQ(all.energy->leaves.absorbed.size(), 3u);
  EXPECT_TRUE(all.energy->sunlit.absorbed.empty());
  EXPECT_TRUE(std::isnan(all.energy->leaf_area.sunlit.mean));
  EXPECT_THAT(error_of([&] { flux(overcast + kTwoPlanes, {.wavelengths = kBandsText, .leaves = {"laef"}}, 1); }),
              HasSubstr("the scene has no material \"laef\"; did you mean \"leaf\"?"));
  EXPECT_THAT(error_of([&] { flux(overcast + kTwoPlanes, {.wavelengths = "bands,wavelengths=550"}, 1); }),
              HasSubstr("bands with responses"));
}

/// Three black squares of 0.5 x 0.5 and one of 0.5 x 1, of which the first two share a mesh, twice in an object.
const std::string kSquares =
    "MakeNamedMaterial \"leaf\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0 2500 0]\n"
    "MakeNamedMaterial \"stem\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0 2500 0]\n"
    "NamedMaterial \"leaf\" Shape \"trianglemesh\" \"point3 P\" [0 0 0  0.5 0 0  0.5 0.5 0  0 0.5 0  "
    "1 0 0.5  1.5 0 0.5  1.5 0.5 0.5  1 0.5 0.5  1 0 0.5] \"integer indices\" [0 1 2  0 2 3  4 5 6  8 6 7]\n"
    "ObjectBegin \"twig\" NamedMaterial \"stem\" Shape \"trianglemesh\" \"point3 P\" [0 1 0  0.5 1 0  0.5 1.5 0  0 1.5 "
    "0] "
    "\"integer indices\" [0 1 2  0 2 3]\nObjectEnd\nObjectInstance \"twig\"\n"
    "AttributeBegin Translate 1 0 0 Scale 1 2 1 Translate 0 -0.5 0 ObjectInstance \"twig\" AttributeEnd\n";

TEST_F(Energy, OfEachOrganIsThatOfItsArea) {
  const std::string sun =
      "LightSource \"distant\" \"point3 from\" [0 0 2] \"point3 to\" [0 0 0] \"spectrum L\" [300 1 2500 1]\n";
  struct Case {
    OrganKind kind;
    std::vector<double> areas;
    std::vector<std::string> names, materials;
    std::vector<uint64_t> instances;
  };
  const std::vector<Case> cases{
      {OrganKind::mesh, {0.5, 0.25, 0.5}, {"leaf", "twig", "twig"}, {"leaf", "stem", "stem"}, {0, 1, 2}},
      {OrganKind::part,
       {0.25, 0.25, 0.25, 0.5},
       {"leaf", "leaf", "twig", "twig"},
       {"leaf", "leaf", "stem", "stem"},
       {0, 0, 1, 2}},
      {OrganKind::triangle,
       {0.125, 0.125, 0.125, 0.125, 0.125, 0.125, 0.25, 0.25},
       {"leaf", "leaf", "leaf", "leaf", "twig", "twig", "twig", "twig"},
       {"leaf", "leaf", "leaf", "leaf", "stem", "stem", "stem", "stem"},
       {0, 0, 0, 0, 1, 1, 2, 2}},
      {OrganKind::instance, {0.25, 0.5}, {"twig", "twig"}, {"stem", "stem"}, {1, 2}}};
  for (const Case& c : cases) {
    SCOPED_TRACE(kOrganKinds[size_t(c.kind)]);
    Session session(silent_log(), {2, {}, {}});
    FluxMeter meter(session, parse_scene_text("WorldBegin\n" + sun + kSquares, "t", silent_log()),
                    {.target = Target{0, 2, 0, 2, 1},
                     .wavelengths = "bands,ranges=400,700,names=par",
                     .organs = c.kind,
                     .energy = true});
    meter.trace(1 << 17, session.pool());
    const FluxMeasurement m = meter.read();
    const Organs& organs = *meter.organs();
    ASSERT_EQ(organs.size(), c.areas.size());
    ASSERT_EQ(m.by_organ.size(), c.areas.size());
    for (size_t i = 0; i < c.areas.size(); ++i) {
      EXPECT_FLOAT_EQ(m.areas[i], float(c.areas[i]));
      EXPECT_EQ(organs.name(i + 1), c.names[i]);
      EXPECT_EQ(organs.material(i + 1), c.materials[i]);
      EXPECT_EQ(organs.instance(i + 1), c.instances[i]);
      const OrganShare& share = m.energy->organs[i];
      EXPECT_NEAR(share.energy.mean, c.areas[i] / 4, kZ * share.energy.standard_error);
      EXPECT_NEAR(share.photons.mean, c.areas[i] / 4, kZ * share.photons.standard_error);
      EXPECT_EQ(share.direct.mean, share.energy.mean);
      EXPECT_LT(share.energy.standard_error, 0.03 * share.energy.mean);
    }
  }
}

/// Black squares of 1 x 1 at z = 0 and 2, and a black wall of 1 x 0.5, in light of a sun at 45 degrees and of a uniform
/// sky. The light of the lower square and of the wall enters through the side.
TEST_F(Energy, OfPlantsThatStandAloneCountsLightThroughTheSides) {
  const std::string world =
      "MakeNamedMaterial \"leaf\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0 2500 0]\n"
      "NamedMaterial \"leaf\" Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  1 1 0  0 1 0] \"integer indices\" [0 "
      "1 2  0 2 3]\n"
      "Shape \"trianglemesh\" \"point3 P\" [1 0 2  2 0 2  2 1 2  1 1 2] \"integer indices\" [0 1 2  0 2 3]\n"
      "Shape \"trianglemesh\" \"point3 P\" [0 3 0  0 4 0  0 4 0.5  0 3 0.5] \"integer indices\" [0 1 2  0 2 3]\n";
  const std::string
      sun = "LightSource \"distant\" \"point3 from\" [-1 0 1] \"point3 to\" [0 0 0] \"spectrum L\" [300 1 2500 1]\n",
      sky = "LightSource \"infinite\" \"spectrum L\" [300 1 2500 1]\n";
  const auto absorbed = [&](const std::string& light, bool sides) {
    const FluxMeasurement m = flux(light + world,
                                   {.target = Target{0, 3, 0, 4, 2},
                                    .wavelengths = "bands,ranges=400,700,names=par",
                                    .sides = sides,
                                    .organs = OrganKind::mesh},
                                   1 << 19);
    std::vector<MeanError> shares;
    for (const OrganShare& share : m.energy->organs)
      shares.push_back({share.energy.mean * m.target_area, share.energy.standard_error * m.target_area});
    return shares;
  };
  const auto expect = [](const MeanError& share, double expected) {
    EXPECT_NEAR(share.mean, expected, kZ * share.standard_error + 3e-4);
    EXPECT_LT(share.standard_error, 0.01);
  };
  const auto direct = absorbed(sun, true), diffuse = absorbed(sky, true), through_top = absorbed(sun, false);
  expect(direct[0], 1);
  expect(direct[1], 1);
  expect(direct[2], 0.5);
  expect(diffuse[1], 1);
  expect(diffuse[2], 0.5 * 2 / 2);  // half of the light of the hemisphere on each of two sides
  expect(through_top[1], 1);
  EXPECT_EQ(through_top[0].mean, 0);
  EXPECT_EQ(through_top[2].mean, 0);
}

/// Two leaves of 1 x 1 under a sun in the zenith. The upper one, black, shades half of the lower one, Lambertian and
/// grey, whose reflected light falls on the lower side of the upper one.
TEST_F(Energy, OfAHalfShadedLeafIsThatOfItsSunlitHalf) {
  const auto square = [](double x, double z) {
    return fmt::format(
        "Shape \"trianglemesh\" \"point3 P\" [{0} 0 {2}  {1} 0 {2}  {1} 1 {2}  {0} 1 {2}] \"integer indices\" [0 1 2  "
        "0 2 "
        "3]\n",
        x, x + 1, z);
  };
  const auto leaf = [](const char* name, double r) {
    return fmt::format(
        "MakeNamedMaterial \"{0}\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 {1} 2500 "
        "{1}]\nNamedMaterial \"{0}\" ",
        name, r);
  };
  const std::string world =
      "LightSource \"distant\" \"point3 from\" [0 0 2] \"point3 to\" [0 0 0] \"spectrum L\" [300 1 2500 1]\n" +
      leaf("lower", 0.5) + square(0, 0) + leaf("upper", 0) + square(0.5, 0.1);
  Session session(silent_log(), {2, {}, {}});
  for (const OrganKind kind : {OrganKind::mesh, OrganKind::triangle}) {
    FluxMeter meter(
        session, parse_scene_text("WorldBegin\n" + world, "t", silent_log()),
        {.wavelengths = "bands,ranges=400,700,names=par", .organs = kind, .energy = true, .leaves = {"lower"}});
    meter.trace(1 << 16, session.pool());
    const FluxMeasurement m = meter.read();
    const auto sunlit = meter.sunlit_organs(session.pool());
    const auto& organs = m.energy->organs;
    const auto expect = [](const MeanError& share, double expected) {
      EXPECT_NEAR(share.mean, expected, kZ * share.standard_error + 1e-4);
    };
    if (kind == OrganKind::triangle) {  // the diagonal from (0, 0) to (1, 1) divides the sunlit half
      ASSERT_EQ(sunlit.size(), 4u);
      expect(sunlit[0], 0.25);
      expect(sunlit[1], 0.75);
      continue;
    }
    ASSERT_EQ(organs.size(), 2u);
    expect(sunlit[0], 0.5);
    expect(sunlit[1], 1);
    EXPECT_LT(sunlit[0].standard_error, 0.005);
    // Of the scene's light on 1.5 x 1, a third falls on the lower leaf, in the sun.
    expect(organs[0].incident_energy, 1.0 / 3);
    expect(organs[0].incident_photons, 1.0 / 3);
    expect(organs[0].energy, 0.5 / 3);
    const MeanError back = {organs[1].incident_energy.mean - 2.0 / 3, organs[1].incident_energy.standard_error};
    EXPECT_GT(back.mean, 5 * back.standard_error);
    EXPECT_LT(back.mean, 0.5 / 3 / 2) << "less than half of the reflected light passes above the shaded half";
    EXPECT_NEAR(organs[1].energy.mean, organs[1].incident_energy.mean, 1e-4) << "black";
    // The sums of the whole scene have the same estimators.
    expect(m.energy->leaf_area.sunlit, sunlit[0].mean);
    EXPECT_NEAR(m.energy->leaves.incident[0].energy.total.mean, organs[0].incident_energy.mean, 1e-6);
  }
}

TEST_F(Energy, AnOrgansCentreIsInTheCoordinatesOfTheFile) {
  Session session(silent_log(), {1, {}, {}});
  const std::string sun = "LightSource \"sky\"\n";
  const auto centers = [&](const std::string& world, OrganKind kind) {
    FluxMeter meter(session, parse_scene_text("WorldBegin\n" + sun + world, "t", silent_log()),
                    {.wavelengths = "bands,wavelengths=550", .organs = kind});
    return meter.organs()->centers();
  };
  const auto expect_at = [](const Vec3d& p, const Vec3d& q) { EXPECT_LT(length(p - q), 1e-6) << p.x << " " << p.y; };
  const auto mesh = centers(kSquares, OrganKind::mesh),
             far = centers("Translate 600000 5e6 0\n" + kSquares, OrganKind::part);
  expect_at(mesh[0], {0.75, 0.25, 0.25});
  expect_at(mesh[1], {0.25, 1.25, 0});
  expect_at(mesh[2], {1.25, 1.5, 0});
  expect_at(far[1], {600001.25, 5000000.25, 0.5});
  const auto by_material =
      centers(kSquares + "NamedMaterial \"leaf\" Translate 3 0 0 Shape \"disk\"\n", OrganKind::material);
  EXPECT_NEAR(by_material[1].x, (0.75 * 0.5 + 3 * kPiD) / (0.5 + kPiD), 1e-3);
}

}  // namespace
}  // namespace frond
