#include "study/compare/comparison.h"

namespace frond::compare {

Convergence Subject::convergence(Region region, size_t channel) const {
  std::vector<ConvergencePoint> points;
  for (const Rung& r : rungs)
    points.push_back({double(r.samples), r.cost.cpu_seconds, r.errors[region][channel].noise});
  return {std::move(points), rungs.back().errors[region][channel].bias};
}

}  // namespace frond::compare
