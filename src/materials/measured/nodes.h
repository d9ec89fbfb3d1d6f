#pragma once

#include <algorithm>
#include <span>

#include "leaf/table/table_axes.h"

namespace frond {

/// Returns the cell of `nodes`, one or more in ascending order, that contains x; beyond the ends t is 0 or 1. With a
/// single node t is 0.
inline leaf::AxisCell cell_of(std::span<const float> nodes, float x) {
  if (nodes.size() < 2) return {0, 0};
  const auto inner = nodes.subspan(1, nodes.size() - 2);
  const auto below = static_cast<uint32_t>(std::ranges::upper_bound(inner, x) - inner.begin());
  return {below, std::clamp((x - nodes[below]) / (nodes[below + 1] - nodes[below]), 0.f, 1.f)};
}

/// Cell of each lane's wavelength; lanes that are not in use have the first.
inline std::array<leaf::AxisCell, kLanes> cells_of(std::span<const float> nodes_nm, const SampledWavelengths& lambda) {
  std::array<leaf::AxisCell, kLanes> cells{};
  for (size_t lane = 0; lane < size_t(lambda.count); ++lane) cells[lane] = cell_of(nodes_nm, lambda.nm[lane]);
  return cells;
}

}  // namespace frond
