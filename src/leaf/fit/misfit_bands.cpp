#include <algorithm>
#include <array>

#include "leaf/fit/bare_leaf.h"
#include "leaf/fit/fit.h"
#include "leaf/solve/lobe_mean.h"
#include "leaf/solve/solver.h"

namespace frond::leaf {

std::vector<MisfitBand> misfit_bands(const FitRequest& request, const FitResult& result) {
  struct Residual {
    double nm, measured, fitted;
    int sign;  ///< 0: small
  };
  const BareLeaf leaf(result.params);
  LobeMeans means;
  std::vector<double> angles;
  for (const LeafMeasurement& m : request.measurements)
    if (std::ranges::find(angles, m.theta_deg) == angles.end()) angles.push_back(m.theta_deg);
  std::vector<MisfitBand> bands;
  for (const double theta_deg : angles)
    for (const bool is_t : {false, true}) {
      std::vector<Residual> all;
      for (size_t i = 0; i < request.measurements.size(); ++i) {
        const LeafMeasurement& m = request.measurements[i];
        const std::optional<double>& measured = is_t ? m.t : m.r;
        if (m.theta_deg != theta_deg || !measured) continue;
        const double fitted = is_t ? result.fitted[i].t : result.fitted[i].r, d = fitted - *measured;
        all.push_back({m.lambda_nm, *measured, fitted, d > kMisfit ? 1 : d < -kMisfit ? -1 : 0});
      }
      std::ranges::stable_sort(all, {}, &Residual::nm);
      for (size_t first = 0, end = 0; first < all.size(); first = end) {
        for (end = first + 1; end < all.size() && all[end].sign == all[first].sign;) ++end;
        const double from = first > 0 ? (all[first - 1].nm + all[first].nm) / 2 : all[first].nm,
                     to = end < all.size() ? (all[end - 1].nm + all[end].nm) / 2 : all[end - 1].nm;
        if (all[first].sign == 0 || (to - from < kMisfitWidth_nm && end - first < all.size())) continue;
        MisfitBand band{theta_deg, {all[first].nm, all[end - 1].nm}, is_t, 0, 0, 1};
        const auto count = static_cast<double>(end - first);
        for (size_t i = first; i < end; ++i)
          band.measured += all[i].measured / count, band.fitted += all[i].fitted / count;
        constexpr double kOpaque = 1e3;  // optical depth
        for (const double nm : {band.nm.min, (band.nm.min + band.nm.max) / 2, band.nm.max}) {
          const Tissue tissue = leaf.at(nm, kOpaque);
          const Shares s = solve_depths({&tissue, 1}, {&theta_deg, 1}, kFitNodes, means)[0][0];
          band.lowest_r = std::min(band.lowest_r, s.surface + s.subsurface);
        }
        bands.push_back(band);
      }
    }
  return bands;
}

}  // namespace frond::leaf
