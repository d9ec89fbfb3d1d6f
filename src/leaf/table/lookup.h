#pragma once

#include <cstdint>

#include "core/spectrum.h"
#include "leaf/table/depth_table.h"
#include "leaf/table/table.h"
#include "leaf/table/table_axes.h"

namespace frond::leaf {

/// Rs, Rd and T for each lane.
struct SampledShares {
  SampledSpectrum surface, subsurface, transmitted;
};

/// A leaf table in the form that a render looks up: linear between nodes that are even in sqrt |cos theta|, where they
/// are dense toward grazing and require no arc cosine. The table's angles are resampled to the nodes by cubic
/// interpolation, separately for angles up to 90 degrees and from 90 degrees on. Constant beyond the table's first and
/// last angle.
class TableLookup {
 public:
  TableLookup() = default;
  /// For paths whose lanes are the table's wavelengths, one by one; at most kLanes.
  static TableLookup for_lanes(const Table& table);
  /// For paths whose lanes vary: the table's wavelengths ascend and are at least two.
  static TableLookup for_spectra(const Table& table);
  /// The same for a leaf whose optical depth varies.
  static TableLookup for_lanes(const DepthTable& table);
  static TableLookup for_spectra(const DepthTable& table);

  /// The columns of a path's lanes and their weights.
  TableSelection select(const SampledWavelengths& lambda) const;
  /// The same for a table with depths, at the leaf's optical depth in each lane.
  TableSelection select(const SampledWavelengths& lambda, const std::array<double, kLanes>& optical_depth) const;

  /// Returns the shares of 1 in each lane. cos_theta in [-1, 1]: cosine of the incident direction to the adaxial
  /// normal. Lanes not in use are undefined.
  SampledShares operator()(float cos_theta, const TableSelection& selection) const {
    const auto [node, t] = position(cos_theta);
    if (selection.lane_count == 0) return mix(lanes_[node], lanes_[node + 1], t);
    return sum_columns(node, t, selection);
  }

  static constexpr size_t kCells = 128;
  static constexpr size_t kNodes = 2 * (kCells + 1);  ///< adaxial side, then abaxial, each from grazing to the normal
  /// Position of a cosine in [-1, 1] on the axis of nodes.
  struct Position {
    size_t node;  ///< the node below; the next is the one above
    float t;      ///< fraction of the distance between them
  };
  static Position position(float cos_theta) {
    const float x = std::sqrt(std::min(std::abs(cos_theta), 1.f)) * kCells;
    const auto cell = std::min(static_cast<size_t>(x), kCells - 1);
    return {(cos_theta < 0 ? kCells + 1 : 0) + cell, x - static_cast<float>(cell)};
  }
  /// Number of (wavelength, depth) columns; kLanes where lanes are wavelengths (lanes not in use hold 0).
  size_t columns() const { return lanes_.empty() ? columns_.size() / kNodes : kLanes; }
  /// Returns the shares of one column at one of kNodes nodes.
  Shares shares(size_t column, size_t node) const {
    const auto lane = static_cast<int>(column);
    if (!lanes_.empty())
      return {lanes_[node].surface[lane], lanes_[node].subsurface[lane], lanes_[node].transmitted[lane]};
    const Node& n = columns_[column * kNodes + node];
    return {n[0], n[1], n[2]};
  }

 private:
  /// (Rs, Rd, T, 0): one column at one node.
  using Node = SampledSpectrum;

  static std::vector<Node> resample(const std::vector<double>& theta_deg, std::span<const Shares> column);
  static SampledShares mix(const SampledShares& a, const SampledShares& b, float t) {
    const float s = 1 - t;
    return {a.surface * s + b.surface * t, a.subsurface * s + b.subsurface * t, a.transmitted * s + b.transmitted * t};
  }
  void add_columns(const std::vector<double>& theta_deg, std::span<const Shares> shares);
  SampledShares sum_columns(size_t node, float t, const TableSelection& selection) const;

  std::vector<SampledShares> lanes_;  ///< [node]
  std::vector<Node> columns_;         ///< [wavelength][depth][node]
  WavelengthAxis wavelengths_;        ///< empty: lanes are wavelengths
  DepthAxis depths_;                  ///< empty: the depth does not vary
};

}  // namespace frond::leaf
