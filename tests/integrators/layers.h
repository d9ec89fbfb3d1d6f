#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/render_text.h"

/// Scenes of media under a camera that looks down, and means of their images in three bands.
namespace frond::test {

/// z-tests below use 5 standard errors: a false alarm in 1.7 million for each.
inline constexpr double kSigmas = 5;
inline constexpr std::array kBands{450.0, 551.0, 650.0};
inline const std::string kSky = "LightSource \"infinite\" \"spectrum L\" [300 1 900 1]\n";

/// Orthographic camera at z = 5 that looks down on a point of the plane z = 0.
inline std::string looking_down(const std::string& world, int depth = 5, const std::string& integrator = "volpath") {
  return fmt::format(R"(
LookAt 0 0 5  0 0 0  0 1 0
Camera "orthographic" "float screenwindow" [-.01 .01 -.01 .01]
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Sampler "independent"
PixelFilter "box"
Integrator "{}" "integer maxdepth" {}
WorldBegin
{})",
                     integrator, depth, world);
}

/// A layer from z = -1 to z = 0 of the medium "m", wide enough to have no sides.
inline std::string layer(const std::string& medium) {
  constexpr std::string_view kPlane =
      "Shape \"trianglemesh\" \"point3 P\" [-900 -900 {0}  900 -900 {0}  900 900 {0}  -900 900 {0}] \"integer "
      "indices\" [0 1 2  0 2 3]\n";
  return "MakeNamedMedium \"m\" " + medium + "\nAttributeBegin\nMaterial \"interface\"\nMediumInterface \"m\" \"\"\n" +
         fmt::format(fmt::runtime(kPlane), 0) + "MediumInterface \"\" \"m\"\n" + fmt::format(fmt::runtime(kPlane), -1) +
         "AttributeEnd\n";
}

struct BandMeans {
  std::vector<double> mean, error;
};

inline BandMeans band_means(const std::string& text, int samples) {
  RenderSettings settings{.samples = samples};
  settings.wavelengths = "bands,wavelengths=450,551,650";
  const Film film = render_text(text, settings);
  BandMeans result;
  const Crop& c = film.settings().crop;
  const double n = double(c.width()) * c.height();
  for (size_t band = 0; band < kBands.size(); ++band) {
    double sum = 0, square = 0;
    for (int y = c.y0; y < c.y1; ++y)
      for (int x = c.x0; x < c.x1; ++x) {
        const double value = film.band_mean(x, y, band).mean;
        sum += value, square += value * value;
      }
    result.mean.push_back(sum / n);
    result.error.push_back(std::sqrt(std::max(0.0, square / n - sum * sum / n / n) / (n - 1)));
  }
  return result;
}

/// Radiance of the sky kSky, on which nothing stands.
inline double sky_radiance() {
  static const double value = band_means(looking_down(kSky), 1).mean[0];
  return value;
}

/// Compares the radiance over that of the sky with `expected(nm)`.
template <class Expected>
void expect_radiance(const std::string& text, int samples, const Expected& expected, double unit = sky_radiance()) {
  const BandMeans found = band_means(text, samples);
  for (size_t band = 0; band < kBands.size(); ++band)
    EXPECT_NEAR(found.mean[band] / unit, expected(kBands[band]), kSigmas * found.error[band] / unit + 2e-5)
        << kBands[band] << " nm";
}

/// Linear from 400 to 700 nm.
inline double ramp(double nm, double at_400, double at_700) { return at_400 + (nm - 400) / 300 * (at_700 - at_400); }

}  // namespace frond::test
