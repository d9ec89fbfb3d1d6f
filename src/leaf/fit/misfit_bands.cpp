#include <algorithm>
#include <array>

#include "leaf/fit/bare_leaf.h"
#include "leaf/fit/fit.h"
#include "leaf/solve/lobe_mean.h"
#include "leaf/solve/solver.h"

namespace frond::leaf {

namespace {

struct Residual {
  double nm, measured, fitted;
  int sign;  ///< 0: small
};

/// Residuals of reflectance or transmittance at one angle, by wavelength.
std::vector<Residual> residuals_of(const FitRequest& request, const FitResult& result, double theta_deg, bool is_t) {
  std::vector<Residual> all;
  for (size_t i = 0; i < request.measurements.size(); ++i) {
    const LeafMeasurement& m = request.measurements[i];
    const std::optional<double>& measured = is_t ? m.t : m.r;
    if (m.theta_deg != theta_deg || !measured) continue;
    const double fitted = is_t ? result.fitted[i].t : result.fitted[i].r, d = fitted - *measured;
    all.push_back({m.lambda_nm, *measured, fitted, d > kMisfit ? 1 : d < -kMisfit ? -1 : 0});
  }
  std::ranges::stable_sort(all, {}, &Residual::nm);
  return all;
}

/// Smallest reflectance of such a leaf at the ends and the middle of an interval, however much it absorbs.
double lowest_reflectance(const BareLeaf& leaf, const Interval& nm, double theta_deg, LobeMeans& means) {
  constexpr double kOpaque = 1e3;  // optical depth
  double lowest = 1;
  for (const double at : {nm.min, (nm.min + nm.max) / 2, nm.max}) {
    const Tissue tissue = leaf.at(at, kOpaque);
    const Shares s = solve_depths({&tissue, 1}, {&theta_deg, 1}, kFitNodes, means)[0][0];
    lowest = std::min(lowest, s.surface + s.subsurface);
  }
  return lowest;
}

}  // namespace

std::vector<MisfitBand> misfit_bands(const FitRequest& request, const FitResult& result) {
  const BareLeaf leaf(result.params);
  LobeMeans means;
  std::vector<double> angles;
  for (const LeafMeasurement& m : request.measurements)
    if (std::ranges::find(angles, m.theta_deg) == angles.end()) angles.push_back(m.theta_deg);
  std::vector<MisfitBand> bands;
  const auto add_bands = [&](double theta_deg, bool is_t) {
    const std::vector<Residual> all = residuals_of(request, result, theta_deg, is_t);
    for (size_t first = 0, end = 0; first < all.size(); first = end) {
      for (end = first + 1; end < all.size() && all[end].sign == all[first].sign;) ++end;
      const double from = first > 0 ? (all[first - 1].nm + all[first].nm) / 2 : all[first].nm,
                   to = end < all.size() ? (all[end - 1].nm + all[end].nm) / 2 : all[end - 1].nm;
      if (all[first].sign == 0 || (to - from < kMisfitWidth_nm && end - first < all.size())) continue;
      MisfitBand band{theta_deg, {all[first].nm, all[end - 1].nm}, is_t, 0, 0, 1};
      const auto count = static_cast<double>(end - first);
      for (size_t i = first; i < end; ++i)
        band.measured += all[i].measured / count, band.fitted += all[i].fitted / count;
      band.lowest_r = lowest_reflectance(leaf, band.nm, theta_deg, means);
      bands.push_back(band);
    }
  };
  for (const double theta_deg : angles)
    for (const bool is_t : {false, true}) add_bands(theta_deg, is_t);
  return bands;
}

}  // namespace frond::leaf
