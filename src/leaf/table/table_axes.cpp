#include "leaf/table/table_axes.h"

#include <cassert>

namespace frond::leaf {

/// Bins about as narrow as the closest wavelengths, so that few steps remain from a bin's start.
WavelengthAxis::WavelengthAxis(const std::vector<double>& wavelengths_nm)
    : nm_(wavelengths_nm.begin(), wavelengths_nm.end()) {
  assert(nm_.size() > 1);
  constexpr float kMostBins = 1 << 16;
  const float range = nm_.back() - nm_.front();
  float narrowest = range;
  for (size_t i = 1; i < nm_.size(); ++i) {
    const float width = nm_[i] - nm_[i - 1];
    narrowest = std::min(narrowest, width);
    per_width_.push_back(width > 0 ? 1 / width : 0);
  }
  const float bins = narrowest > 0 ? std::min(std::ceil(range / narrowest), kMostBins) : kMostBins;
  bins_per_nm_ = bins / range;
  last_bin_ = bins - 1;
  for (uint32_t bin = 0, below = 0; bin <= static_cast<uint32_t>(last_bin_); ++bin) {
    const float begin = nm_[0] + static_cast<float>(bin) / bins_per_nm_;
    while (below + 2 < nm_.size() && nm_[below + 1] <= begin) ++below;
    first_in_bin_.push_back(below);
  }
}

DepthAxis::DepthAxis(double least, double most, double step) {
  // Depth below which absorption is negligible: linear from 0 there.
  constexpr double kLeastShare = 1e-5, kLeastDepth = 1e-9;
  if (least < kLeastShare * most) {
    depths_.push_back(0);
    zero_ = 1;
  }
  const double first = std::max({least, kLeastShare * most, kLeastDepth});
  const double width = std::max(std::log(most / first), 0.0);
  const double steps = std::max(1.0, std::ceil(width / step));
  for (int i = 0; i <= static_cast<int>(steps); ++i) depths_.push_back(first * std::exp(width * i / steps));
  first_ = static_cast<float>(first);
  log_first_ = static_cast<float>(std::log(first));
  constexpr double kNoWidth = 1e-3;  // all depths alike
  per_step_ = static_cast<float>(steps / std::max(width, kNoWidth));
  last_ = static_cast<float>(steps);
}

TableSelection select_columns(const WavelengthAxis& wavelengths, const DepthAxis& depths,
                              const SampledWavelengths& lambda, const std::array<double, kLanes>& optical_depth) {
  TableSelection selection;
  selection.lane_count = lambda.count;
  selection.columns_per_lane = wavelengths.empty() ? 2 : 4;
  const auto rows = static_cast<uint32_t>(depths.depths().size());
  for (size_t lane = 0; lane < static_cast<size_t>(lambda.count); ++lane) {
    const AxisCell w =
        wavelengths.empty() ? AxisCell{static_cast<uint32_t>(lane), 0} : wavelengths.cell(lambda.nm[lane]);
    const AxisCell d = depths.cell(optical_depth[lane]);
    const uint32_t near = w.below * rows + d.below, far = near + rows;
    const float s = 1 - w.t;
    selection.lanes[lane] = {{near, near + 1, far, far + 1}, {s * (1 - d.t), s * d.t, w.t * (1 - d.t), w.t * d.t}};
  }
  return selection;
}

TableSelection select_columns(const WavelengthAxis& wavelengths, const SampledWavelengths& lambda) {
  TableSelection selection;
  selection.lane_count = lambda.count;
  selection.columns_per_lane = wavelengths.empty() ? 1 : 2;
  for (size_t lane = 0; lane < static_cast<size_t>(lambda.count); ++lane) {
    const auto [below, t] =
        wavelengths.empty() ? AxisCell{static_cast<uint32_t>(lane), 0} : wavelengths.cell(lambda.nm[lane]);
    selection.lanes[lane] = {{below, below + 1}, {1 - t, t}};
  }
  return selection;
}

}  // namespace frond::leaf
