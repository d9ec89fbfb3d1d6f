#include <benchmark/benchmark.h>

#include "bench/bundle_render.h"

/// CPU time of a path among leaves that move while the shutter is open, relative to the time among the same leaves at
/// rest. Names do not change between releases.
namespace frond {
namespace {

/// The hundred leaves, each moved by `motion` in its own space.
SceneDescription moved(const Transform& motion) {
  SceneDescription d = BundleRender::described("hundred-leaves/scene.pbrt", "diffusetransmission");
  for (size_t i = 0; i < d.instances.objects.size(); ++i) {
    const AffineMap start = (*d.instances.maps)[i];
    Transform::RowsDouble rows;
    for (size_t k = 0; k < 3; ++k) std::copy(start.rows[k].begin(), start.rows[k].end(), rows[k].begin());
    const AffineMap end{(Transform(rows) * motion).rows()};
    d.instances.moving.push_back({d.instances.objects[i], start, end, {precise_rows(start), precise_rows(end)}, {}});
  }
  d.instances.maps->clear();
  d.instances.objects.clear();
  return d;
}

void path_in_motion(benchmark::State& state, const Transform& motion) {
  BundleRender moving(moved(motion));
  BundleRender still(BundleRender::described("hundred-leaves/scene.pbrt", "diffusetransmission"));
  compare_paths(state, moving, still);
}

// A leaf is 0.1 long in its own space; it turns about its base.
BENCHMARK_CAPTURE(path_in_motion, shift, Transform::translate({0, 0, 0.02f}))
    ->Iterations(6)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(path_in_motion, turn_10, Transform::rotate(10, {0, 1, 0}))
    ->Iterations(6)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(path_in_motion, turn_90, Transform::rotate(90, {0, 1, 0}))
    ->Iterations(6)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace frond
