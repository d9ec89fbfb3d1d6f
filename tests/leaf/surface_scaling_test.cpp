#include "leaf/table/surface_scaling.h"

#include <gtest/gtest.h>

#include <numbers>

#include "leaf/solve/azimuth.h"
#include "leaf/solve/quadrature.h"
#include "leaf/tissue/fresnel.h"

namespace frond::leaf {
namespace {

using std::numbers::pi;

constexpr Interval kIndices{1.41, 1.54};

double arriving(const SurfaceScaling& scaling, double exponent, double cosine, double index) {
  const auto n = static_cast<float>(index);
  const SurfaceScaling::Position place = scaling.position(static_cast<float>(exponent));
  return static_cast<double>(scaling.at(place, static_cast<float>(cosine), Float4{n, n, n, n})[0]);
}

/// Returns the share of light from one direction that the scaled lobe reflects, by a quadrature finer than its own.
double reflected(const SurfaceScaling& scaling, double exponent, double cosine, double index) {
  static const std::vector<QuadratureNode> rule = gauss_legendre(400);
  const AzimuthModes azimuth(exponent);
  const auto factor = [&](double c) {
    return fresnel(c, 1 / index).reflectance / arriving(scaling, exponent, c, index);
  };
  double sum = 0;
  for (const auto& [x, weight] : rule) {
    const double theta = x * pi / 2, c = std::cos(theta);
    sum += weight * pi / 2 * std::sin(theta) * c * (exponent + 1) * azimuth.mean(cosine, c) * factor(c);
  }
  return factor(cosine) * sum;
}

TEST(SurfaceScaling, LeavesFresnelsReflectance) {
  for (const double exponent : {0.0, 0.3, 1.0, 5.0, 10.0, 100.0, 1000.0}) {
    const SurfaceScaling scaling({exponent, exponent}, kIndices);
    for (const double index : {1.42, 1.47, 1.53})
      for (const double cosine : {1e-6, 1e-3, 0.01, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9, 0.97, 1.0})
        EXPECT_NEAR(reflected(scaling, exponent, cosine, index), fresnel(cosine, 1 / index).reflectance, 1e-4)
            << exponent << ", " << index << ", " << cosine;
  }
}

TEST(SurfaceScaling, IsBoundedFromBelow) {
  for (const double exponent : {0.0, 5.0, 1000.0}) {
    const SurfaceScaling scaling({exponent, exponent}, kIndices);
    for (const double index : {1.41, 1.54})
      for (double x = 0; x <= 1; x += 1.0 / 512) EXPECT_GT(arriving(scaling, exponent, x * x, index), 0.06);
  }
}

TEST(SurfaceScaling, InterpolatesExponents) {
  const SurfaceScaling range({0.5, 200}, kIndices);
  for (const double exponent : {0.53, 1.1, 4.7, 33.3, 180.0}) {
    const SurfaceScaling one({exponent, exponent}, kIndices);
    for (const double cosine : {1e-3, 0.1, 0.3, 0.6, 1.0}) {
      const double exact = arriving(one, exponent, cosine, 1.5);
      EXPECT_NEAR(arriving(range, exponent, cosine, 1.5), exact, 3e-4 * exact) << exponent << ", " << cosine;
    }
  }
}

}  // namespace
}  // namespace frond::leaf
