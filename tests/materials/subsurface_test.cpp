// Material "subsurface": the table of photon beam diffusion, the BSSRDF's factors, and what its parameters exclude.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/bssrdf.h"
#include "materials/lobes/tabulated_bssrdf.h"
#include "tests/materials/support.h"
#include "tests/support/input_error.h"
#include "tests/support/render_text.h"

namespace frond {
namespace {

const BeamDiffusion& table_of(double g, double eta) {
  static std::map<std::pair<double, double>, BeamDiffusion> made;
  return made.try_emplace({g, eta}, g, eta, ThreadPool(2)).first->second;
}

// Fresnel's formula integrated: 0.4595 and 0.0660 for diffuse light that meets water (eta 1.33) are textbook values of
// 2 M_1 to the digits that Egan and Hilgeman's fits give.
TEST(Subsurface, FresnelMomentsAreIntegrals) {
  EXPECT_NEAR(2 * fresnel_moment(1.33, 1), 0.0659, 2e-4);
  // Reciprocity: (1 - R outside) = n^2 (1 - R inside).
  for (const double eta : {1.1, 1.33, 1.5, 2.0})
    EXPECT_NEAR(1 - 2 * fresnel_moment(eta, 1), eta * eta * (1 - 2 * fresnel_moment(1 / eta, 1)), 2e-3) << eta;
}

TEST(Subsurface, ReflectanceGrowsWithTheAlbedoAndNeverExceedsOne) {
  for (const auto& [g, eta] : {std::pair{-0.9, 1.33}, {0.0, 1.0}, {0.0, 1.33}, {0.6, 2.0}}) {
    float before = 0;
    for (const float albedo : {0.01f, 0.1f, 0.5f, 0.9f, 0.99f, 0.999f, 1.f}) {
      const float reflectance = table_of(g, eta).reflectance(albedo);
      EXPECT_GE(reflectance, before) << g << " " << eta;
      EXPECT_LE(reflectance, 1) << g << " " << eta;
      before = reflectance;
    }
  }
}

TEST(Subsurface, TheAlbedoIsTheInverseOfTheReflectance) {
  const BeamDiffusion& table = table_of(0, 1.33);
  for (const float albedo : {0.01f, 0.2f, 0.7f, 0.95f, 0.999f})
    EXPECT_NEAR(table.albedo(table.reflectance(albedo)), albedo, 1e-4f);
  EXPECT_EQ(table.albedo(0), 0);
  EXPECT_NEAR(table.reflectance(table.albedo(1)), 1, 1e-4f);
}

TEST(Subsurface, TheInverseIsRightForDarkBodiesToo) {
  for (const auto& [g, eta] : {std::pair{-0.9, 1.33}, {0.0, 1.0}, {0.0, 1.33}, {0.9, 1.33}, {0.99, 3.0}}) {
    const BeamDiffusion& table = table_of(g, eta);
    for (float reflectance = 1e-4f; reflectance < 0.99f * table.reflectance(1); reflectance *= 1.03f)
      EXPECT_NEAR(table.reflectance(table.albedo(reflectance)) / reflectance, 1, 1e-3f) << g << " " << eta;
  }
}

// The integral of the profile over the plane, and means of a function of the radius by quadrature and by samples.
TEST(Subsurface, RadiiHaveTheDensityOfTheProfile) {
  for (const float albedo : {0.05f, 0.6f, 0.97f, 0.9999f}) {
    const BeamProfile profile(table_of(0, 1.33), albedo);
    constexpr int kSteps = 20000;
    constexpr double kEnd = 202;
    double all = 0, by_quadrature = 0, by_samples = 0;
    for (int i = 0; i < kSteps; ++i) {
      const auto edge = [](double at) { return kEnd * std::pow(at / kSteps, 3); };
      const double r = edge(i + 0.5), step = edge(i + 1) - edge(i);
      const double light = 2 * std::numbers::pi * r * double(profile.at(float(r))) * step;
      all += light, by_quadrature += light / (1 + r);
      by_samples += 1 / (1 + double(profile.radius((float(i) + 0.5f) / kSteps)));
    }
    EXPECT_NEAR(all, double(profile.reflectance()), 3e-4 * all);
    EXPECT_NEAR(by_quadrature / all, by_samples / kSteps, 3e-4);
  }
}

// Sw has the integral n^2 with the cosine, so that entry and exit together return the table's share.
TEST(Subsurface, TheExitReturnsWhatTheEntryTook) {
  constexpr float kEta = 1.5f;
  const InterfaceExitBsdf exit(kEta, float(1 - 2 * fresnel_moment(1.5, 1)), SampledSpectrum(1));
  double sum = 0;
  constexpr int kSteps = 10000;
  RandomStream rng(1);
  for (int i = 0; i < kSteps; ++i) {
    const float cosine = (float(i) + 0.5f) / kSteps;
    const Vec3 wi{std::sqrt(1 - cosine * cosine), 0, cosine};
    sum += 2 * std::numbers::pi * double(exit.f({0, 0, 1}, wi, rng)[0] * cosine) / kSteps;
  }
  EXPECT_NEAR(sum, double(kEta * kEta), 1e-3);
}

std::string message_of(const std::string& material, const std::string& more = "") {
  return error_of([&] {
    (void)test::render_text("Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n" + more +
                                "\nWorldBegin\n" + material + "\nShape \"sphere\"\n",
                            {.samples = 1, .wavelengths = "hero"});
  });
}

TEST(Subsurface, ParametersThatExcludeEachOtherAreNamed) {
  const auto expect = [](const std::string& params, const std::string& part) {
    const std::string message = message_of("Material \"subsurface\" " + params);
    EXPECT_NE(message.find(part), std::string::npos) << params << ": " << message;
  };
  expect("\"string name\" \"Apple\" \"rgb sigma_a\" [1 1 1]", "\"sigma_a\" and \"name\" exclude each other");
  expect("\"rgb sigma_a\" [1 1 1]", "\"sigma_a\" is given without \"sigma_s\"");
  expect("\"rgb sigma_s\" [1 1 1]", "\"sigma_s\" is given without \"sigma_a\"");
  expect("\"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [1 1 1] \"rgb reflectance\" [1 1 1]",
         "\"reflectance\" and \"sigma_a\" exclude each other");
  expect("\"rgb mfp\" [1 1 1]", "\"mfp\" has no effect without \"reflectance\"");
  expect("\"string name\" \"Appel\"", "did you mean \"Apple\"");
  EXPECT_EQ(message_of("Material \"subsurface\" \"rgb sigma_a\" [9 2 3] \"rgb sigma_s\" [40 50 60]"), "");
  EXPECT_EQ(message_of("Material \"subsurface\" \"string name\" \"Apple\" \"float g\" .5"), "");
}

TEST(Subsurface, MixturesRefuseIt) {
  const std::string message = message_of(
      "MakeNamedMaterial \"flesh\" \"string type\" \"subsurface\"\nMakeNamedMaterial \"skin\" \"string type\" "
      "\"diffuse\"\nMaterial \"mix\" \"string materials\" [\"flesh\" \"skin\"]");
  EXPECT_NE(message.find("\"flesh\" is a \"subsurface\", which no other material can contain"), std::string::npos)
      << message;
}

}  // namespace
}  // namespace frond
