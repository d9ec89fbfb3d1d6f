#include "leaf/solve/side_curves.h"

namespace frond::leaf {
namespace {

double sum(const Shares& s) { return s.surface + s.subsurface + s.transmitted; }

}  // namespace

SideCurves::SideCurves(const std::vector<double>& theta_deg, std::span<const Shares> column, bool abaxial) {
  const bool mirrored = abaxial && theta_deg.back() > 90;
  std::vector<double> theta, surface, subsurface, transmitted, all;
  for (size_t k = 0; k < theta_deg.size(); ++k) {
    const size_t i = mirrored ? theta_deg.size() - 1 - k : k;
    const double from_normal = mirrored ? 180 - theta_deg[i] : theta_deg[i];
    if (from_normal > 90) break;
    const Shares& s = column[i];
    theta.push_back(from_normal);
    surface.push_back(s.surface);
    subsurface.push_back(s.subsurface);
    transmitted.push_back(s.transmitted);
    all.push_back(sum(s));
  }
  surface_.emplace(theta, std::move(surface));
  subsurface_.emplace(theta, std::move(subsurface));
  transmitted_.emplace(theta, std::move(transmitted));
  all_.emplace(theta, std::move(all));
}

Shares SideCurves::at(double theta_deg) const {
  const Shares s{(*surface_)(theta_deg), (*subsurface_)(theta_deg), (*transmitted_)(theta_deg)};
  const double all = sum(s), scale = all > 0 ? (*all_)(theta_deg) / all : 0;
  return {s.surface * scale, s.subsurface * scale, s.transmitted * scale};
}

}  // namespace frond::leaf
