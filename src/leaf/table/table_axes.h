#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/spectrum.h"

namespace frond::leaf {

/// Position between two nodes of an axis.
struct AxisCell {
  uint32_t below;
  float t;  ///< fraction of the distance to the next node, in [0, 1]
};

/// Wavelengths of a table, with any spacing.
class WavelengthAxis {
 public:
  WavelengthAxis() = default;
  /// At least two, ascending.
  explicit WavelengthAxis(const std::vector<double>& wavelengths_nm);

  /// Whether the axis has no nodes.
  bool empty() const { return nm_.empty(); }
  /// Returns the cell that contains a wavelength; the first or last one beyond the ends, where t is clamped.
  AxisCell cell(float nm) const {
    const auto bin = static_cast<size_t>(std::clamp((nm - nm_[0]) * bins_per_nm_, 0.f, last_bin_));
    uint32_t below = first_in_bin_[bin];
    while (below + 2 < nm_.size() && nm >= nm_[below + 1]) ++below;
    return {below, std::clamp((nm - nm_[below]) * per_width_[below], 0.f, 1.f)};
  }

 private:
  std::vector<float> nm_, per_width_;   ///< 1 / width of the cell that begins there
  std::vector<uint32_t> first_in_bin_;  ///< index of the wavelength below the start of each of many even steps
  float bins_per_nm_ = 0, last_bin_ = 0;
};

/// Step of the natural logarithm of depth in tables of modes: linear interpolation leaves errors of pi f below 3e-4.
inline constexpr double kDepthStep = 0.15;

/// Optical depths of a table, even in their logarithm; a first node 0 is added if the range starts at 0.
class DepthAxis {
 public:
  DepthAxis() = default;
  /// From `least` to `most`, 0 <= least <= most, in steps of at most `step` of the natural logarithm.
  DepthAxis(double least, double most, double step);

  bool empty() const { return depths_.empty(); }
  const std::vector<double>& depths() const { return depths_; }
  /// Returns the cell that contains a depth; beyond the ends t is clamped.
  AxisCell cell(double depth) const {
    const auto d = static_cast<float>(depth);
    if (d <= first_) return {0, zero_ == 0 ? 0.f : std::max(0.f, d / first_)};
    const float x = std::min((std::log(d) - log_first_) * per_step_, last_);
    const auto whole = std::min(static_cast<uint32_t>(x), static_cast<uint32_t>(last_) - 1);
    return {zero_ + whole, x - static_cast<float>(whole)};
  }

 private:
  std::vector<double> depths_;
  float first_ = 0, log_first_ = 0, per_step_ = 0, last_ = 1;
  uint32_t zero_ = 0;  ///< 1 if depth 0 is a node of its own
};

/// The columns that the lanes of a path use: each lane is a weighted sum of columns. Computed once per hit, for any
/// number of directions.
struct TableSelection {
  /// Columns of one lane and their weights; the first columns_per_lane are used.
  struct Lane {
    std::array<uint32_t, 4> column{};
    std::array<float, 4> weight{};
  };
  std::array<Lane, kLanes> lanes;
  int lane_count = 0;        ///< 0: the lanes are the table's wavelengths, one by one
  int columns_per_lane = 0;  ///< at most 4
};

/// Selection in a table of columns [wavelength][depth]. An empty axis of wavelengths: lanes are the wavelengths, one by
/// one.
TableSelection select_columns(const WavelengthAxis& wavelengths, const DepthAxis& depths,
                              const SampledWavelengths& lambda, const std::array<double, kLanes>& optical_depth);
/// Selection in a table of columns [wavelength].
TableSelection select_columns(const WavelengthAxis& wavelengths, const SampledWavelengths& lambda);

}  // namespace frond::leaf
