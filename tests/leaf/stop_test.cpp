// Solutions and walks end when a stop is requested. The stop is requested before each call.

#include <vector>

#include "leaf/solve/modes.h"
#include "leaf/solve/solver.h"
#include "leaf/tissue/specimens.h"
#include "leaf/walk/batch_walk.h"
#include "tests/support/expect_stopped.h"

namespace frond::leaf {
namespace {

using test::expect_stopped;

Tissue soybean() {
  static const TissueModel model(find_specimen("soybean")->params);
  return model.at(551);
}

TEST(Stop, EndsASolution) {
  const std::vector<double> angles{0, 60};
  expect_stopped([&] { (void)solve(soybean(), angles); });
}

TEST(Stop, EndsASolutionByModes) {
  const std::vector<double> sines{0, 0.5, 0.9};
  expect_stopped([&] { (void)solve_modes(soybean(), sines, 1e-4, mode_nodes(soybean())); });
}

TEST(Stop, EndsABatchOfWalks) {
  std::vector<BatchRay> rays(1 << 17);
  expect_stopped([&] { walk_batch(soybean(), {0, 0, 1}, Absorption::analog, 1, rays); });
}

}  // namespace
}  // namespace frond::leaf
