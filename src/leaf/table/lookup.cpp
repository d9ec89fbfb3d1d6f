#include "leaf/table/lookup.h"

#include <cassert>
#include <numbers>

#include "leaf/solve/side_curves.h"

namespace frond::leaf {
std::vector<TableLookup::Node> TableLookup::resample(const std::vector<double>& theta_deg,
                                                     std::span<const Shares> column) {
  std::vector<Node> nodes(kNodes);
  for (size_t i = 0; i < kNodes; i += kCells + 1) {
    const SideCurves side(theta_deg, column, i > 0);
    for (size_t k = 0; k <= kCells; ++k) {
      const double x = static_cast<double>(k) / kCells;
      const Shares s = side.at(std::acos(x * x) * 180 / std::numbers::pi);
      nodes[i + k].v =
          Float4{static_cast<float>(s.surface), static_cast<float>(s.subsurface), static_cast<float>(s.transmitted), 0};
    }
  }
  return nodes;
}

void TableLookup::add_columns(const std::vector<double>& theta_deg, std::span<const Shares> shares) {
  for (size_t first = 0; first < shares.size(); first += theta_deg.size()) {
    const std::vector<Node> nodes = resample(theta_deg, shares.subspan(first, theta_deg.size()));
    columns_.insert(columns_.end(), nodes.begin(), nodes.end());
  }
}

TableLookup TableLookup::for_lanes(const Table& table) {
  assert(table.wavelengths_nm.size() <= kLanes);
  TableLookup lookup;
  lookup.lanes_.resize(kNodes);
  for (size_t lane = 0; lane < table.wavelengths_nm.size(); ++lane) {
    const size_t angles = table.theta_deg.size();
    const std::vector<Node> nodes = resample(table.theta_deg, std::span(table.shares).subspan(lane * angles, angles));
    for (size_t i = 0; i < kNodes; ++i) {
      lookup.lanes_[i].surface[int(lane)] = nodes[i][0];
      lookup.lanes_[i].subsurface[int(lane)] = nodes[i][1];
      lookup.lanes_[i].transmitted[int(lane)] = nodes[i][2];
    }
  }
  return lookup;
}

TableLookup TableLookup::for_spectra(const Table& table) {
  TableLookup lookup;
  lookup.wavelengths_ = WavelengthAxis(table.wavelengths_nm);
  lookup.add_columns(table.theta_deg, table.shares);
  return lookup;
}

TableLookup TableLookup::for_lanes(const DepthTable& table) {
  assert(table.wavelengths_nm.size() <= kLanes);
  TableLookup lookup;
  lookup.depths_ = table.depths;
  lookup.add_columns(table.theta_deg, table.shares);
  return lookup;
}

TableLookup TableLookup::for_spectra(const DepthTable& table) {
  TableLookup lookup;
  lookup.depths_ = table.depths;
  lookup.add_columns(table.theta_deg, table.shares);
  lookup.wavelengths_ = WavelengthAxis(table.wavelengths_nm);
  return lookup;
}

TableSelection TableLookup::select(const SampledWavelengths& lambda) const {
  return wavelengths_.empty() ? TableSelection() : select_columns(wavelengths_, lambda);
}

TableSelection TableLookup::select(const SampledWavelengths& lambda,
                                   const std::array<double, kLanes>& optical_depth) const {
  return select_columns(wavelengths_, depths_, lambda, optical_depth);
}

SampledShares TableLookup::sum_columns(size_t node, float t, const TableSelection& selection) const {
  SampledShares shares;
  for (int lane = 0; lane < selection.lane_count; ++lane) {
    const TableSelection::Lane& at = selection.lanes[static_cast<size_t>(lane)];
    Node sum;
    for (size_t i = 0; i < static_cast<size_t>(selection.columns_per_lane); ++i) {
      const Node* nodes = &columns_[at.column[i] * kNodes + node];
      sum += nodes[0] * (at.weight[i] * (1 - t)) + nodes[1] * (at.weight[i] * t);
    }
    shares.surface[lane] = sum[0];
    shares.subsurface[lane] = sum[1];
    shares.transmitted[lane] = sum[2];
  }
  return shares;
}

}  // namespace frond::leaf
