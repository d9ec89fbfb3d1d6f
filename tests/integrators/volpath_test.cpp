// The integrator volpath against closed forms and solutions of the transfer equation.

#include <cmath>
#include <numbers>
#include <vector>

#include "spectra/analytic.h"
#include "spectra/cie.h"
#include "tests/integrators/layers.h"

namespace frond {
namespace {

using namespace test;

TEST(VolPath, AnAbsorbingLayerTransmitsTheExponential) {
  expect_radiance(
      looking_down(kSky + layer(R"("string type" "homogeneous" "spectrum sigma_a" [400 .3 700 2.4] "float sigma_s" 0
                                   "float scale" .5)")),
      4096, [](double nm) { return std::exp(-0.5 * ramp(nm, 0.3, 2.4)); });
}

// Radiance tends to Le: the source is sigma_a Le.
TEST(VolPath, AnAbsorbingLayerEmits) {
  expect_radiance(looking_down(layer(R"("string type" "homogeneous" "spectrum sigma_a" [400 .3 700 2.4]
                                        "float sigma_s" 0 "spectrum Le" [300 1 900 1] "float Lescale" 3)")),
                  4096, [](double nm) { return 3 * (1 - std::exp(-ramp(nm, 0.3, 2.4))); });
}

/// Radiance of a layer of thickness 1 whose density is a grid of one cell, 1 - |u - 1/2|, by quadrature.
/// `emitted(share)` is the emission relative to the sky's, for the share `share` of the grid's value.
template <class Emitted>
double emitting_layer(double sigma_a, const Emitted& emitted) {
  constexpr int kSteps = 20000;
  double radiance = 0, depth = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double share = 1 - std::abs((i + 0.5) / kSteps - 0.5), step = sigma_a * share / kSteps;
    radiance += emitted(share) * std::exp(-depth - step / 2) * step;
    depth += step;
  }
  return radiance;
}
const std::string kCell = R"( "float sigma_s" 0 "point3 p0" [-100 -100 -1] "point3 p1" [100 100 0])";

// Le is scaled by a grid of one cell if nothing else is given, as in pbrt-v4.
TEST(VolPath, AUniformGridEmits) {
  expect_radiance(looking_down(layer(R"("string type" "uniformgrid" "float density" 1 "spectrum Le" [300 1 900 1]
                            "spectrum sigma_a" [400 .3 700 2.4])" +
                                     kCell)),
                  4096,
                  [](double nm) { return emitting_layer(ramp(nm, 0.3, 2.4), [](double share) { return share; }); });
}

// A blackbody of largest value 1; the sky has luminance 1 and the same value at each wavelength.
TEST(VolPath, AUniformGridGlowsByItsTemperature) {
  const double sky = 1 / photometric(ConstantSpectrum(1, {360, 830}));
  expect_radiance(looking_down(layer(R"("string type" "uniformgrid" "float density" 1 "float temperature" 7000
                            "float temperatureoffset" 1000 "float temperaturescale" .9
                            "spectrum sigma_a" [400 .3 700 2.4])" +
                                     kCell)),
                  4096, [sky](double nm) {
                    return emitting_layer(ramp(nm, 0.3, 2.4), [&](double share) {
                      const double kelvin = (7000 * share - 1000) * 0.9;
                      return double(BlackbodySpectrum(kelvin).at(float(nm))) * share / sky;
                    });
                  });
}

// Le of an rgb grid is not normalized: for white it is D65 whose integral equals the integral of ybar.
TEST(VolPath, AnRgbGridEmits) {
  const double integral = photometric(ConstantSpectrum(1, {360, 830}));
  expect_radiance(
      looking_down(layer(R"("string type" "rgbgrid" "rgb Le" [1 1 1] "float Lescale" 2 "rgb sigma_a" [1.5 1.5 1.5]
                            "rgb sigma_s" [0 0 0] "point3 p0" [-100 -100 -1] "point3 p1" [100 100 0])")),
      4096, [integral](double nm) {
        const double white = double(unit_d65()->at(float(nm))) * integral * integral;
        return emitting_layer(1.5, [&](double share) { return 2 * share * white; });
      });
}

// Nothing is lost or made by the phase function, by the choice of the hero wavelength or by roulette.
TEST(VolPath, AMediumWithoutAbsorptionIsNotSeenInAFurnace) {
  for (const std::string g : {"-.6", "0", ".8"})
    expect_radiance(looking_down(kSky + R"(MakeNamedMedium "m" "string type" "homogeneous" "float sigma_a" 0
                               "spectrum sigma_s" [400 1 700 8] "float g" )" +
                                     g + R"(
AttributeBegin
Material "interface"
MediumInterface "m" ""
Shape "sphere" "float radius" 1
AttributeEnd
AttributeBegin
Material "diffuse" "spectrum reflectance" [300 1 900 1]
Shape "sphere" "float radius" .4
AttributeEnd
)",
                                 10000),
                    1024, [](double) { return 1; });
}

/// Chandrasekhar's H function for isotropic scattering with this albedo (Radiative Transfer, 1950, eq. V.5), by
/// iteration of its integral equation in the form 1/H = sqrt(1 - w) + w/2 int x H(x) / (m + x) dx.
double h_function(double albedo, double mu) {
  constexpr int kNodes = 400;
  std::vector<double> x(kNodes), h(kNodes, 1.0);
  for (int i = 0; i < kNodes; ++i) x[size_t(i)] = (i + 0.5) / kNodes;
  const auto at = [&](double m) {
    double sum = 0;
    for (size_t i = 0; i < x.size(); ++i) sum += x[i] * h[i] / (m + x[i]) / kNodes;
    return 1 / (std::sqrt(1 - albedo) + albedo / 2 * sum);
  };
  for (int iteration = 0; iteration < 200; ++iteration) {
    std::vector<double> next;
    for (const double m : x) next.push_back(at(m));
    h = next;
  }
  return at(mu);
}

double albedo_at(double nm) { return ramp(nm, 0.4, 0.95); }
const std::string kDeep = layer(R"("string type" "homogeneous" "spectrum sigma_a" [400 60 700 5]
                                   "spectrum sigma_s" [400 40 700 95])");

// Under a uniform sky the radiance at the cosine m is the plane albedo, 1 - H(m) sqrt(1 - w).
TEST(VolPath, ADeepLayerUnderAnEvenSkyReflectsAsTheHFunctionSays) {
  expect_radiance(looking_down(kSky + kDeep, 1000), 2048,
                  [](double nm) { return 1 - h_function(albedo_at(nm), 1) * std::sqrt(1 - albedo_at(nm)); });
}

// I(m) = w/4 m0 / (m + m0) H(m) H(m0) E / pi for the irradiance E of a beam at normal incidence: by light samples.
TEST(VolPath, ADeepLayerUnderABeamReflectsAsTheHFunctionSays) {
  const double mu = std::sqrt(0.5);
  const std::string beam =
      "LightSource \"distant\" \"spectrum L\" [300 1 900 1] \"point3 from\" [1 0 1] \"point3 to\" [0 0 0]\n";
  const std::string white =
      "Material \"diffuse\" \"spectrum reflectance\" [300 1 900 1]\nShape \"disk\" \"float radius\" 3\n";
  const double e = band_means(looking_down(beam + white), 1).mean[0] * std::numbers::pi / mu;
  expect_radiance(
      looking_down(beam + kDeep, 1000), 2048,
      [mu](double nm) {
        const double w = albedo_at(nm);
        return w / (4 * std::numbers::pi) * mu / (1 + mu) * h_function(w, 1) * h_function(w, mu);
      },
      e);
}

/// A grid of 4 x 1 x 1 along z, from z = -1 to z = 0, in a wide box of interfaces.
const std::string kGrid = R"("string type" "uniformgrid" "integer nz" 4 "float density" [.5 2 1 4]
  "point3 p0" [-100 -100 -1] "point3 p1" [100 100 0] "spectrum sigma_a" [400 .3 700 2.4] "float sigma_s" 0)";
/// Optical depth through it along z: the sum of densities over 4, less the fade of the two outermost to half.
double grid_depth(double nm) { return (0.5 + 2 + 1 + 4 - (0.5 + 4) / 8) / 4 * ramp(nm, 0.3, 2.4); }

TEST(VolPath, DeltaTrackingFindsTheOpticalDepthOfAGrid) {
  expect_radiance(looking_down(kSky + layer(kGrid)), 4096, [](double nm) { return std::exp(-grid_depth(nm)); });
}

// The plane below is lit from above through the grid, by shadow rays. The camera looks from beneath the grid.
TEST(VolPath, RatioTrackingFindsTheOpticalDepthOfAGrid) {
  const std::string beam =
      "LightSource \"distant\" \"spectrum L\" [300 1 900 1] \"point3 from\" [0 0 1] \"point3 to\" [0 0 0]\n";
  const std::string white =
      "Translate 0 0 -2 Material \"diffuse\" \"spectrum reflectance\" [300 1 900 1]\nShape \"disk\" \"float radius\" "
      ".9\n";
  const auto from_below = [](std::string text) {
    const std::string view = "LookAt 0 0 5  0 0 0  0 1 0";
    return text.replace(text.find(view), view.size(), "LookAt .6 0 -1.4  0 0 -2  0 1 0");
  };
  const double unit = band_means(from_below(looking_down(beam + white)), 1).mean[0];
  expect_radiance(
      from_below(looking_down(beam + layer(kGrid) + white)), 4096, [](double nm) { return std::exp(-grid_depth(nm)); },
      unit);
}

// Path and volpath render the same scene without media, in which every kind of light sample and hit occurs.
/// Far from the camera floats are farther apart than the collisions of a dense cell, most of whose collisions are null.
TEST(VolPath, ADenseCellFarFromTheCameraIsTracked) {
  std::string densities = "1e5";
  for (int i = 1; i < 64; ++i) densities += " 0";
  const std::string far = looking_down(
      "LightSource \"infinite\"\nTranslate .2501 .2501 0\nMakeNamedMedium \"m\" \"string type\" \"uniformgrid\" "
      "\"integer nx\" 4 \"integer ny\" "
      "4 "
      "\"integer nz\" 4 \"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1] \"float sigma_a\" 1 \"float sigma_s\" 0 "
      "\"float density\" [" +
      densities + "]\nMaterial \"interface\"\nMediumInterface \"m\" \"\"\nShape \"sphere\"\n");
  const BandMeans through = band_means("Translate 0 0 3000\n" + far, 4);
  for (size_t band = 0; band < kBands.size(); ++band) EXPECT_TRUE(std::isfinite(through.mean[band]));
}

TEST(VolPath, AgreesWithPathWithoutMedia) {
  const std::string world = R"(
LightSource "infinite" "spectrum L" [300 1 900 1]
LightSource "point" "point3 from" [1 0 2]
AttributeBegin
AreaLightSource "diffuse" "spectrum L" [300 1 900 1]
Translate 0 2 2
Shape "sphere" "float radius" .5
AttributeEnd
AttributeBegin
Material "dielectric" "float roughness" .3
Translate 0 0 1
Shape "sphere" "float radius" .3
AttributeEnd
Material "diffusetransmission" "spectrum reflectance" [300 .5 900 .6] "spectrum transmittance" [300 .2 900 .3]
Shape "disk" "float radius" 3
Translate 0 0 -1
Shape "disk" "float radius" 3
)";
  const BandMeans a = band_means(looking_down(world, 8, "path"), 2048), b = band_means(looking_down(world, 8), 2048);
  for (size_t i = 0; i < kBands.size(); ++i)
    EXPECT_NEAR(a.mean[i], b.mean[i], kSigmas * std::hypot(a.error[i], b.error[i])) << kBands[i];
}

// Path, with light samples and without, and volpath agree on hair under a sky and a lamp.
TEST(VolPath, AgreesWithPathOnHair) {
  std::string world = R"(
LightSource "infinite" "spectrum L" [300 .5 900 .5]
AttributeBegin
AreaLightSource "diffuse" "spectrum L" [300 2 900 2]
Translate 0 2 2
Shape "sphere" "float radius" .8
AttributeEnd
Material "hair" "spectrum sigma_a" [300 .05 900 .4] "float beta_m" .4
)";
  for (const double x : {-0.6, -0.2, 0.1, 0.5})
    world += fmt::format(
        "Shape \"curve\" \"string type\" \"cylinder\" \"float width\" .4 \"point3 P\" [ {0} -2 0  {0} -1 {0}  {0} 1 "
        "{0}  {0} 2 "
        "0 ]\n",
        x);
  std::string scattered = looking_down(world, 8, "path");
  scattered.insert(scattered.find("\"integer maxdepth\""), "\"bool sampledirect\" false ");
  const BandMeans a = band_means(looking_down(world, 8, "path"), 1024);
  for (const std::string& other : {looking_down(world, 8), scattered}) {
    const BandMeans b = band_means(other, 1024);
    for (size_t i = 0; i < kBands.size(); ++i)
      EXPECT_NEAR(a.mean[i], b.mean[i], kSigmas * std::hypot(a.error[i], b.error[i])) << kBands[i];
  }
}

// Light samples, scattered rays alone, and both with each selection of lights have the same mean.
TEST(VolPath, LightSamplesDoNotChangeTheMean) {
  const std::string world = layer(R"("string type" "homogeneous" "spectrum sigma_a" [400 .2 700 .1]
                                     "spectrum sigma_s" [400 1 700 3] "float g" .5)") +
                            R"(
AttributeBegin
AreaLightSource "diffuse" "spectrum L" [300 1 900 1]
Translate 1 0 .8
Shape "sphere" "float radius" .5
Translate -2 0 0
Shape "sphere" "float radius" .3
AttributeEnd
)";
  const auto with = [&](const std::string& parameters) {
    std::string text = looking_down(world, 20);
    return band_means(text.insert(text.find("\"integer maxdepth\""), parameters), 4096);
  };
  const BandMeans a = with(""), b = with("\"bool sampledirect\" false "),
                  c = with("\"string lightsampler\" \"power\" ");
  for (size_t i = 0; i < kBands.size(); ++i) {
    EXPECT_NEAR(a.mean[i], b.mean[i], kSigmas * std::hypot(a.error[i], b.error[i])) << kBands[i];
    EXPECT_NEAR(a.mean[i], c.mean[i], kSigmas * std::hypot(a.error[i], c.error[i])) << kBands[i];
  }
}

// Leaves of vanishing size with all orientations equally likely: the gap fraction is exp(-LAI / 2), as G = 1/2.
TEST(VolPath, ATurbidMediumHasTheGapFractionOfSphericalLeaves) {
  expect_radiance(
      looking_down(kSky + layer(R"("string type" "turbid" "float density" 3 "spectrum reflectance" [300 0 900 0])")),
      4096, [](double) { return std::exp(-1.5); });
}

}  // namespace
}  // namespace frond
