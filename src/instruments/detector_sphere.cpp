#include "instruments/detector_sphere.h"

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/math/vec.h"

namespace frond {
namespace {

/// cos(180 k / thetas degrees), exactly 0 at the horizon, so that no patch receives rays from the other side.
double cos_edge(int k, int thetas) {
  if (2 * k == thetas) return 0;
  return std::cos(std::numbers::pi * k / thetas);
}

int checked(int thetas, int phis) {
  if (thetas < 1 || phis < 1) fail({}, "a goniophotometer needs patches, {} x {} were asked for", thetas, phis);
  if (thetas % 2 != 0)
    fail({},
         "{} patches in theta would leave one across the horizon, which mixes reflected with transmitted light: an "
         "even number is needed",
         thetas);
  if (int64_t{thetas} * phis > DetectorSphere::kMostPatches)
    fail({}, "{} x {} patches are more than {}", thetas, phis, DetectorSphere::kMostPatches);
  return thetas;
}

}  // namespace

DetectorSphere::DetectorSphere(int thetas, int phis)
    : thetas_(checked(thetas, phis)), phis_(phis), z_(z_edges(thetas)), diamond_(diamond_edges(phis)) {}

std::vector<double> DetectorSphere::z_edges(int thetas) {
  std::vector<double> edges;
  for (int k = thetas; k >= 0; --k) edges.push_back(cos_edge(k, thetas));
  return edges;
}

std::vector<double> DetectorSphere::diamond_edges(int phis) {
  std::vector<double> edges{0};
  for (int k = 0; k < phis; ++k) {
    const double phi = 2 * std::numbers::pi * (k + 0.5) / phis;
    edges.push_back(diamond_angle(std::cos(phi), std::sin(phi)));
  }
  edges.push_back(4);
  return edges;
}

Patch DetectorSphere::patch(int theta, int phi) const {
  const double theta_step = 180.0 / thetas_, phi_step = 360.0 / phis_;
  Patch p{theta * theta_step, (theta + 1) * theta_step, (phi - 0.5) * phi_step, (phi + 0.5) * phi_step, 0, 0};
  const double top = cos_edge(theta, thetas_), bottom = cos_edge(theta + 1, thetas_), width = phi_step * kDegree;
  p.solid_angle = width * (top - bottom);
  p.projected_solid_angle = width * std::abs(top - bottom) * std::abs(top + bottom) / 2;
  return p;
}

Patch DetectorSphere::patch(size_t i) const {
  const auto phis = static_cast<size_t>(phis_);
  return patch(static_cast<int>(i / phis), static_cast<int>(i % phis));
}

}  // namespace frond
