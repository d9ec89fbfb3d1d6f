// Fluorescence of scenes, against closed forms and between light paths and camera paths.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "radiometry/fluorescence_flux.h"
#include "radiometry/flux.h"
#include "radiometry/horizontal_irradiance.h"
#include "scene/fluorescence_by_material.h"
#include "scene/format/parser.h"
#include "spectra/cie.h"
#include "spectra/wavelengths/radiant.h"
#include "tests/support/input_error.h"

namespace frond {
namespace {

using ::testing::HasSubstr;

// Each comparison allows 4.5 standard errors: a false alarm of 7e-6 each, below 1e-3 for all of this file.
constexpr double kZ = 4.5;

const std::string kSun =
    "LightSource \"distant\" \"point3 from\" [-0.5 0 0.8660254] \"point3 to\" [0 0 0] \"spectrum L\" \"stdillum-E\"\n";
const std::string kSky = "LightSource \"infinite\" \"spectrum L\" \"stdillum-E\"\n";
const std::string kLeaf =
    "MakeNamedMaterial \"leaf\" \"string type\" \"leaf_solved\" \"float fluorescence\" 0.01 \"float tolerance\" 0.05\n";
/// A Lambertian leaf by its shares and matrices, quick to load.
const std::string kReplayed =
    "MakeNamedMaterial \"leaf\" \"string type\" \"leaf_lambert\" \"string tablefile\" \"shares.csv\" "
    "\"string fluorescencematrices\" \"matrices.csv\"\n";
const std::string kBlack =
    "MakeNamedMaterial \"soil\" \"string type\" \"diffuse\" \"spectrum reflectance\" [300 0 2500 0]\n";

/// A horizontal square of 2 x 2, a whole period.
std::string square(const std::string& material, double z) {
  return fmt::format("NamedMaterial \"{0}\" Shape \"bilinearmesh\" \"point3 P\" [0 0 {1}  2 0 {1}  0 2 {1}  2 2 {1}]\n",
                     material, z);
}

/// Squares of a quarter of the period, so that light passes between them.
std::string gaps(const std::string& material, double z) {
  return fmt::format(
      "NamedMaterial \"{0}\" Shape \"bilinearmesh\" \"point3 P\" [0 0 {1}  1.4 0 {1}  0 1.4 {1}  1.4 1.4 {1}]\n",
      material, z);
}

const std::array<double, 2> kPeriod{2, 2};
const std::vector<double> kEmission{685, 740};

class SceneFluorescence : public ::testing::Test {
 protected:
  SceneFluorescence() : folder_("scene_fluorescence") {
    std::string shares = "theta_deg,wavelength_nm,Rs,Rd,T\n";
    for (const auto& [nm, r, t] : {std::array{400.0, 0.05, 0.01},
                                   {500.0, 0.05, 0.02},
                                   {550.0, 0.12, 0.1},
                                   {680.0, 0.05, 0.02},
                                   {720.0, 0.3, 0.3},
                                   {760.0, 0.47, 0.45},
                                   {850.0, 0.48, 0.47}})
      shares += fmt::format("8,{},0,{},{}\n", nm, r, t);
    folder_.write("shares.csv", shares);
    for (const auto& [name, factor] : {std::pair{"matrices.csv", 1.0}, {"weak.csv", 0.05}}) {
      std::string matrices = "excitation_nm,emission_nm,Mb,Mf\n";
      for (double e = 400; e <= 750; e += 50)
        for (double f = 640; f <= 850; f += 10)
          matrices += fmt::format("{},{},{:.6g},{:.6g}\n", e, f, factor * lit(e, f), factor * opposite(e, f));
      folder_.write(name, matrices);
    }
  }

  /// Photons per nm that leave the lit side and the other side; linear between the wavelengths of the file.
  static double lit(double excitation_nm, double emission_nm) {
    return 1e-7 * (800 - excitation_nm) * (1 + (emission_nm - 640) / 100);
  }
  static double opposite(double excitation_nm, double emission_nm) { return 0.5 * lit(excitation_nm, emission_nm); }

  SceneDescription description(const std::string& world, const std::string& options = "") const {
    const auto path = folder_.write("scene.pbrt", options + "WorldBegin\n" + world);
    return parse_scene(path, silent_log());
  }
  BrfMeasurement brf(const std::string& world, const std::vector<ViewDirection>& views, uint64_t samples,
                     int threads = 2) const {
    Session session(silent_log(), {threads, {}, {}});
    const BrfMeter meter(session, description(world),
                         {.views = views,
                          .period = kPeriod,
                          .wavelengths = fmt::format("bands,fluorescence={}", fmt::join(kEmission, ",")),
                          .fluorescence = true});
    RenderPart part = meter.scene().empty_part();
    session.render(meter.scene(), {0, samples}, part);
    return meter.read(part.film);
  }
  FluorescenceFluxMeasurement flux(const std::string& world, uint64_t paths, int threads = 2,
                                   const std::string& options = "", bool by_instance = false) const {
    Session session(silent_log(), {threads, {}, {}});
    FluorescenceFluxMeter meter(session, description(world, options),
                                {.period = kPeriod, .emission_nm = kEmission, .by_instance = by_instance});
    meter.trace(paths, session.pool());
    return meter.read();
  }

  TestFolder folder_;
};

/// Matrices times irradiance over pi, on either side of a leaf.
TEST_F(SceneFluorescence, ALambertianLeafHasTheRadianceOfItsMatrices) {
  Session session(silent_log(), {2, {}, {}});
  for (const std::string& light : {kSun, kSky}) {
    const LoadedScene loaded = session.load(description(light + kReplayed + square("leaf", 0),
                                                        "Option \"string wavelengths\" \"bands,fluorescence=685\"\n"));
    const SpectrumPtr irradiance = horizontal_irradiance(loaded.scene(), kExcitation_nm, ThreadPool(2));
    const std::vector<ViewDirection> views{{0, 0}, {-60, 0}, {45, 90}};
    const BrfMeasurement measured = brf(light + kReplayed + square("leaf", 0), views, 16);
    for (size_t view = 0; view < views.size(); ++view)
      for (size_t band = 0; band < kEmission.size(); ++band) {
        // The environment lights the lower side as well.
        const double below = light == kSky ? opposite(1, 1) / lit(1, 1) : 0;
        double sum = 0;
        for (double nm = kExcitation_nm.min + 0.5; nm < kExcitation_nm.max; ++nm)
          sum += (1 + below) * lit(nm, kEmission[band]) * double(irradiance->at(float(nm))) * nm / kEmission[band] *
                 std::numbers::inv_pi;
        const MeanError& v = measured.at(view, band);
        EXPECT_NEAR(v.mean / sum, 1, kZ * v.standard_error / sum + 3e-4) << light << view << " " << band;
        EXPECT_LT(v.standard_error / sum, 0.01);
      }
  }
}

/// Sum over the wavelengths of excitation of f(wo, wi) E(excitation) excitation / emission.
TEST_F(SceneFluorescence, ALeafInTheSunHasTheRadianceOfItsOperator) {
  Session session(silent_log(), {2, {}, {}});
  const LoadedScene loaded = session.load(
      description(kSun + kLeaf + square("leaf", 0), "Option \"string wavelengths\" \"bands,fluorescence=685\"\n"));
  std::vector<const Material*> materials;
  for (size_t i = 0; i < loaded.description().materials.size(); ++i) materials.push_back(loaded.scene().material(i));
  const auto by_material =
      fluorescence_by_material(materials, {loaded.scene().wavelengths(), session.pool(), silent_log(), {}});
  const auto fluorescence = *std::ranges::find_if(by_material, [](const auto& f) { return f != nullptr; });
  const SpectrumPtr irradiance = horizontal_irradiance(loaded.scene(), kExcitation_nm, ThreadPool(2));
  const Vec3 wi{-0.5f, 0, 0.8660254f};
  const std::vector<ViewDirection> views{{0, 0}, {-60, 0}, {45, 90}};
  const BrfMeasurement measured = brf(kSun + kLeaf + square("leaf", 0), views, 64);
  RandomStream random(1);
  for (size_t view = 0; view < views.size(); ++view)
    for (size_t band = 0; band < kEmission.size(); ++band) {
      // The azimuth is that of the side away from the sun.
      const double zenith = views[view].zenith_deg * std::numbers::pi / 180,
                   azimuth = views[view].azimuth_deg * std::numbers::pi / 180;
      const Vec3 wo{float(std::sin(zenith) * std::cos(azimuth)), float(std::sin(zenith) * std::sin(azimuth)),
                    float(std::cos(zenith))};
      double sum = 0;
      for (double nm = kExcitation_nm.min + 0.25; nm < kExcitation_nm.max; nm += 0.5)
        sum += 0.5 * fluorescence->f(wo, wi, kEmission[band], nm, random) * double(irradiance->at(float(nm))) * nm /
               kEmission[band];
      const MeanError& v = measured.at(view, band);
      EXPECT_NEAR(v.mean / sum, 1, kZ * v.standard_error / sum + 1e-4) << view << " " << band;
      EXPECT_LT(v.standard_error / sum, 0.01);
    }
}

/// Light paths count what camera paths gather: under a sun, under a sky, and with light that leaves scatter and absorb.
TEST_F(SceneFluorescence, LightPathsAndCameraPathsAgree) {
  const std::string leaves = kReplayed + kBlack + gaps("leaf", 1) + square("leaf", 0.6) + square("soil", 0);
  for (const std::string& light : {kSun, kSky, kSun + kSky}) {
    // Gauss's rule of four points in the squared sine, by eight azimuths: the integral of L cos over the hemisphere.
    const std::array<std::pair<double, double>, 4> nodes{{{0.0694318442, 0.1739274226},
                                                          {0.3300094782, 0.3260725774},
                                                          {0.6699905218, 0.3260725774},
                                                          {0.9305681558, 0.1739274226}}};
    std::vector<ViewDirection> views;
    std::vector<double> weights;
    for (const auto& [square_of_sine, weight] : nodes)
      for (int azimuth = 0; azimuth < 8; ++azimuth) {
        views.push_back({std::asin(std::sqrt(square_of_sine)) * 180 / std::numbers::pi, 45.0 * azimuth + 10});
        weights.push_back(weight * std::numbers::pi / 8);
      }
    const BrfMeasurement seen = brf(light + leaves, views, 8);
    const FluorescenceFluxMeasurement counted = flux(light + leaves, 100'000);
    for (size_t band = 0; band < kEmission.size(); ++band) {
      double photons = 0, variance = 0;
      for (size_t view = 0; view < views.size(); ++view) {
        const double factor = weights[view] * kEmission[band] / kPhotonEnergy / counted.incident;
        photons += factor * seen.at(view, band).mean;
        variance += std::pow(factor * seen.at(view, band).standard_error, 2);
      }
      const MeanError& up = counted.upward[band];
      // The rule of 32 directions is accurate to 0.3 %.
      EXPECT_NEAR(photons / up.mean, 1,
                  kZ * std::sqrt(variance + up.standard_error * up.standard_error) / up.mean + 3e-3)
          << light << band;
      EXPECT_LT(std::sqrt(variance + up.standard_error * up.standard_error) / up.mean, 0.01);
    }
  }
}

TEST_F(SceneFluorescence, PhotonsAreConserved) {
  const FluorescenceFluxMeasurement m =
      flux(kSun + kSky + kLeaf + kBlack + gaps("leaf", 1) + square("leaf", 0.6) + square("soil", 0), 200'000);
  EXPECT_GT(m.excited.mean, 0.5);
  EXPECT_LT(m.excited.mean, 1);
  for (size_t band = 0; band < kEmission.size(); ++band) {
    EXPECT_NEAR((m.reabsorbed[band].mean + m.left[band].mean) / m.emitted[band].mean, 1, 1e-4);
    double ends = m.upward[band].mean + m.downward[band].mean, error = m.upward[band].standard_error;
    for (const auto& material : m.materials) {
      ends += material.absorbed[band].mean;
      error += material.absorbed[band].standard_error;
    }
    EXPECT_NEAR(ends / m.left[band].mean, 1, kZ * error / m.left[band].mean + 1e-3);
    EXPECT_LT(error / m.left[band].mean, 0.01);
    EXPECT_NEAR(m.escape[band].mean, m.upward[band].mean / m.left[band].mean, 1e-6);
  }
  // Red light is reabsorbed between the leaves, far-red light is not.
  EXPECT_LT(m.escape[0].mean, m.escape[1].mean);
}

TEST_F(SceneFluorescence, ResultsDoNotDependOnThreads) {
  const std::string world = kSky + kReplayed + gaps("leaf", 1) + gaps("leaf", 0.6);
  EXPECT_EQ(brf(world, {{0, 0}}, 2, 1).at(0, 0).mean, brf(world, {{0, 0}}, 2, 3).at(0, 0).mean);
  EXPECT_EQ(flux(world, 3000, 1).upward[0].mean, flux(world, 3000, 3).upward[0].mean);
}

// Pairs of paths begin in strata. The variance between 40 seeds over the stated one is chi-square with 39 degrees of
// freedom over 39, if the estimates are normal: false alarms, had the seeds not been fixed, 1e-4 for each of 4
// quantities.
TEST_F(SceneFluorescence, StatedErrorsAreThoseOfSeeds) {
  constexpr int kSeeds = 40;
  constexpr uint64_t kPaths = 6'400;  // an incomplete last run
  const std::string world = kSun + kReplayed + "ObjectBegin \"o\"\n" + gaps("leaf", 1) +
                            "ObjectEnd\nObjectInstance \"o\"\nTranslate 0 0 -0.4\nObjectInstance \"o\"\n";
  std::array<std::array<double, kSeeds>, 4> values{};
  std::array<double, 4> variance{};
  for (int seed = 0; seed < kSeeds; ++seed) {
    const FluorescenceFluxMeasurement m =
        flux(world, kPaths, 2, fmt::format("Option \"integer seed\" {}\n", seed + 1), true);
    const std::array measured{m.left[0], m.upward[1], m.escape[0], m.instances[0].left[0]};
    for (size_t q = 0; q < measured.size(); ++q) {
      values[q][size_t(seed)] = measured[q].mean;
      variance[q] += measured[q].standard_error * measured[q].standard_error / kSeeds;
    }
    // A leaf of 0.49 of the area, in paths that begin independently, has at least this variance.
    const double relative = m.instances[0].left[0].standard_error / m.instances[0].left[0].mean;
    EXPECT_LT(relative * relative * double(kPaths), 0.6 * (1 - 0.49) / 0.49);
  }
  for (size_t q = 0; q < values.size(); ++q) {
    double mean = 0, squares = 0;
    for (const double v : values[q]) mean += v / kSeeds;
    for (const double v : values[q]) squares += (v - mean) * (v - mean) / (kSeeds - 1);
    EXPECT_GT(squares / variance[q], 0.35) << q;
    EXPECT_LT(squares / variance[q], 2.13) << q;
  }
}

// Sums of instances have a unit: their errors would be 0 if it were too large.
TEST_F(SceneFluorescence, WeakEmissionOfInstancesHasAnErrorToo) {
  std::string weak = kReplayed;
  weak.replace(weak.find("matrices.csv"), 12, "weak.csv");
  const std::string object = "ObjectBegin \"o\"\n" + gaps("leaf", 1) + "ObjectEnd\nObjectInstance \"o\"\n";
  const auto relative_error = [&](const std::string& leaf) {
    const MeanError left = flux(kSun + leaf + object, 2000, 2, "", true).instances[0].left[0];
    return left.standard_error / left.mean;
  };
  EXPECT_NEAR(relative_error(weak) / relative_error(kReplayed), 1, 1e-3);
}

/// Light that only excites, without any at the wavelengths of emission.
TEST_F(SceneFluorescence, ABlueLampExcitesRedLight) {
  const std::string lamp =
      "LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"spectrum L\" [300 0 449 0 450 1 460 1 "
      "461 "
      "0 2500 0]\n";
  const BrfMeasurement m = brf(lamp + kReplayed + square("leaf", 0), {{0, 0}}, 16);
  EXPECT_GT(m.at(0, 1).mean, 0);
  EXPECT_LT(m.at(0, 1).standard_error, 0.03 * m.at(0, 1).mean);
}

TEST_F(SceneFluorescence, BandsOfBothKindsStandBesideEachOther) {
  const auto means = [&](const std::string& wavelengths) {
    Session session(silent_log(), {2, {}, {}});
    const LoadedScene loaded = session.load(description(
        kSky + kReplayed + "AttributeBegin Scale 10 10 1\n" + square("leaf", 0) + "AttributeEnd\n",
        "Option \"string wavelengths\" \"" + wavelengths +
            "\"\nLookAt 10 10 5  10 10 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]\n"
            "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nPixelFilter \"box\"\n"));
    RenderPart part = loaded.empty_part();
    session.render(loaded, {0, 128}, part);
    std::vector<MeanError> result;
    for (size_t band = 0; band < part.film.bands(); ++band) {
      double sum = 0, squares = 0;
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
          const double value = part.film.band_mean(x, y, band).mean;
          sum += value, squares += value * value;
        }
      result.push_back({sum / 64, std::sqrt(std::max(0.0, squares / 64 - sum * sum / 64 / 64) / 63)});
    }
    return result;
  };
  const auto both = means("bands,wavelengths=550,740,fluorescence=740,685,760"),
             reflected = means("bands,wavelengths=550,740"), emitted = means("bands,fluorescence=740,685,760");
  ASSERT_EQ(both.size(), 5u);
  for (size_t band = 0; band < 5; ++band) {
    const MeanError& alone = band < 2 ? reflected[band] : emitted[band - 2];
    EXPECT_NEAR(both[band].mean / alone.mean, 1,
                kZ * std::hypot(both[band].standard_error, alone.standard_error) / alone.mean + 1e-3)
        << band;
    EXPECT_LT(both[band].standard_error, 0.02 * both[band].mean);
  }
}

/// The colours of `hero` are those without fluorescence, plus those of its radiance.
TEST_F(SceneFluorescence, ColorsCanShowIt) {
  // A lamp that only excites: what arrives between 640 and 830 nm is fluorescence.
  const std::string lamp =
      "LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"spectrum L\" [300 0 399 0 400 1 500 1 "
      "501 "
      "0 2500 0]\n";
  const auto luminance = [&](const std::string& wavelengths) {
    Session session(silent_log(), {2, {}, {}});
    const LoadedScene loaded = session.load(description(
        lamp + kReplayed + square("leaf", 0),
        "Option \"string wavelengths\" \"" + wavelengths +
            "\"\nLookAt 1 1 5  1 1 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-.5 .5 -.5 .5]\n"
            "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nPixelFilter \"box\"\n"));
    RenderPart part = loaded.empty_part();
    session.render(loaded, {0, 256}, part);
    double sum = 0;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        const Triple c = part.film.mean(x, y);  // linear sRGB
        sum += (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]) / 64;
      }
    return sum;
  };
  const double without = luminance("hero,lambdamin=400"), with = luminance("hero,lambdamin=400,fluorescence=true");
  // Luminances by the matrix and by the reflectance, 0.05 up to 500 nm.
  double emitted = 0, reflected = 0;
  for (double nm = 360.5; nm < 830; ++nm) {
    const double ybar = cie_xyz(nm)[1];
    if (nm > 400 && nm < 500) reflected += ybar * 0.05;
    if (nm > kEmission_nm.min)
      for (double excitation = 400.5; excitation < 500; ++excitation)
        emitted += ybar * lit(excitation, nm) * excitation / nm;
  }
  EXPECT_NEAR((with / without - 1) / (emitted / reflected), 1, 0.05);  // the standard error is about 0.01
  EXPECT_THAT(error_of([&] { luminance("hero,fluorescence=true,lambdamin=450"); }),
              HasSubstr("fluorescence is excited from 400 to 750 nm"));
  EXPECT_THAT(error_of([&] { luminance("smpte,fluorescence=true"); }), HasSubstr("fluorescence"));
}

TEST_F(SceneFluorescence, ErrorsSayWhatToDo) {
  const auto loaded = [&](const std::string& world, const std::string& options) {
    return error_of([&] { Session(silent_log(), {1, {}, {}}).load(description(world, options)); });
  };
  const std::string bands = "Option \"string wavelengths\" \"bands,fluorescence=740\"\n";
  EXPECT_THAT(loaded(kSun + kBlack + square("soil", 0), bands), HasSubstr("a quantum yield, as in"));
  EXPECT_THAT(loaded(kSun + kReplayed + square("leaf", 0), bands + "Integrator \"volpath\"\n"),
              HasSubstr("integrator \"volpath\" computes no fluorescence: \"path\" does"));
  EXPECT_THAT(loaded(kSun, "Option \"string wavelengths\" \"bands,fluorescence=900\"\n"), HasSubstr("640"));
  EXPECT_THAT(loaded(kSun, "Option \"string wavelengths\" \"bands,fluorescence=740,740\"\n"),
              HasSubstr("two bands at 740 nm"));
  Session session(silent_log(), {1, {}, {}});
  EXPECT_THAT(error_of([&] {
                FluxMeter(session, description(kSun + kReplayed + square("leaf", 0)),
                          {.wavelengths = "bands,fluorescence=740"});
              }),
              HasSubstr("brf and flux measure them with --fluorescence"));
}

}  // namespace
}  // namespace frond
