// NanoVDB files, as the medium "nanovdb" reads them.

#include "media/nanovdb_grid.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(nanovdb, bytes) {
  std::unique_ptr<NanoVdbGrid> grid;
  if (!fuzz::accepts([&] { grid = NanoVdbGrid::read(bytes, "grid.nvdb", "density", {}); }) || !grid) return;
  const Bounds b = grid->bounds();
  fuzz::require_finite(std::array{b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z}, "the box");
  const float middle = grid->at((b.min + b.max) * 0.5f);
  fuzz::require(middle >= 0, "a density is not negative");
  grid->for_each([](const Vec3&, const Vec3&, float value) { fuzz::require(value > 0, "values above 0 are listed"); });
}
