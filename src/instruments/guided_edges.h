#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace frond {

/// Intervals between ascending edges, found in constant time by a table of start positions.
class GuidedEdges {
 public:
  /// At least two edges, the first below the last.
  explicit GuidedEdges(std::vector<double> edges);

  /// Returns i with edges[i] <= x < edges[i + 1]; outside all, the first or the last interval.
  size_t find(double x) const {
    const double cell = (x - edges_.front()) * cells_per_unit_;
    const double last = static_cast<double>(guide_.size() - 1);
    size_t i = guide_[static_cast<size_t>(cell > 0 ? (cell < last ? cell : last) : 0)];
    while (i > 0 && x < edges_[i]) --i;  // rounding of `cell`
    while (i + 2 < edges_.size() && x >= edges_[i + 1]) ++i;
    return i;
  }

 private:
  std::vector<double> edges_;
  std::vector<uint32_t> guide_;  ///< interval at the lower end of each cell
  double cells_per_unit_;
};

}  // namespace frond
