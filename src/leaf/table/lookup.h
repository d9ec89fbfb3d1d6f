#pragma once

#include <cstdint>

#include "core/spectrum.h"
#include "leaf/table/depth_table.h"
#include "leaf/table/table.h"
#include "leaf/table/table_axes.h"

namespace frond::leaf {

/// Rs, Rd and T lane by lane.
struct SampledShares {
  SampledSpectrum surface, subsurface, transmitted;
};

/// A table made ready for the render loop: linear between nodes that are even in sqrt |cos theta|, where they are dense
/// toward grazing and need no arc cosine. The table's angles are carried over to the nodes by cubic interpolation, each
/// side by its own: those up to 90 degrees and those from there on. Where these do not reach, the nearest holds.
class TableLookup {
 public:
  TableLookup() = default;
  /// Lanes of paths are the table's wavelengths, one by one; at most kLanes.
  static TableLookup for_lanes(const Table& table);
  /// Lanes are anywhere between the table's wavelengths, which are two at least, and ascend.
  static TableLookup for_spectra(const Table& table);
  /// The same two for a leaf whose depth varies.
  static TableLookup for_lanes(const DepthTable& table);
  static TableLookup for_spectra(const DepthTable& table);

  TableSelection select(const SampledWavelengths& lambda) const;
  /// With the leaf's optical depth in each lane.
  TableSelection select(const SampledWavelengths& lambda, const std::array<double, kLanes>& optical_depth) const;

  /// cos_theta in [-1, 1], of the incident direction to the adaxial normal. Lanes not in use: undefined.
  SampledShares operator()(float cos_theta, const TableSelection& selection) const {
    const auto [node, t] = position(cos_theta);
    if (selection.lane_count == 0) return mix(lanes_[node], lanes_[node + 1], t);
    return sum_columns(node, t, selection);
  }

  static constexpr size_t kCells = 128;
  static constexpr size_t kNodes = 2 * (kCells + 1);  ///< adaxial side, then abaxial, each from grazing to the normal
  /// Where a cosine in [-1, 1] lies.
  struct Position {
    size_t node;  ///< the one below; the next is the one above
    float t;      ///< of the way between them
  };
  static Position position(float cos_theta) {
    const float x = std::sqrt(std::min(std::abs(cos_theta), 1.f)) * kCells;
    const auto cell = std::min(static_cast<size_t>(x), kCells - 1);
    return {(cos_theta < 0 ? kCells + 1 : 0) + cell, x - static_cast<float>(cell)};
  }
  /// Wavelengths and depths; where lanes are wavelengths, kLanes, of which those not in use hold 0.
  size_t columns() const { return lanes_.empty() ? columns_.size() / kNodes : kLanes; }
  /// Of one of `columns` at one of kNodes.
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
