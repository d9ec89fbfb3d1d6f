#include "instruments/guided_edges.h"

#include <cassert>

namespace frond {

GuidedEdges::GuidedEdges(std::vector<double> edges) : edges_(std::move(edges)) {
  assert(edges_.size() >= 2 && edges_.front() < edges_.back());
  constexpr size_t kCellsPerInterval = 8;
  const size_t cells = kCellsPerInterval * (edges_.size() - 1);
  const double width = (edges_.back() - edges_.front()) / static_cast<double>(cells);
  cells_per_unit_ = 1 / width;
  uint32_t interval = 0;
  for (size_t cell = 0; cell < cells; ++cell) {
    const double low = edges_.front() + static_cast<double>(cell) * width;
    while (interval + 2 < edges_.size() && low >= edges_[interval + 1]) ++interval;
    guide_.push_back(interval);
  }
}

}  // namespace frond
