// Integrators that trace one path at a time.

#include <gtest/gtest.h>

#include "core/integrator.h"
#include "scene/registry.h"
#include "tests/support/bind.h"

namespace frond {
namespace {

class EmptyWorld final : public World {
 public:
  bool intersect(const Ray&, uint64_t, SurfacePoint&) const override { return false; }
  bool occluded(const Ray&, uint64_t) const override { return false; }
  std::span<const Light* const> lights() const override { return {}; }
  std::span<const EnvironmentLight* const> environment() const override { return {}; }
  float radius() const override { return 1; }
  const WavelengthStrategy& wavelengths() const override { std::abort(); }
};

/// Says what it was given.
class Echo final : public OnePathIntegrator {
 public:
  PathResult trace(const World&, const Ray& ray, SampledWavelengths, PathContext& context) const override {
    PathResult result;
    result.radiance[0] = context.sampler.get1d();
    result.radiance[1] = context.sampler.get2d().y;
    result.radiance[2] = ray.o.x;
    result.scatterings = int(context.key);
    context.rays += 3;
    return result;
  }
};

TEST(OnePathIntegrator, GetsEachSampleOfABundleThatIsWanted) {
  const Registry registry = make_registry({}, {});
  const auto sampler = test::make_plugin(registry.samplers.get("lattice", {}), {}, uint64_t{4});
  const EmptyWorld world;
  const Echo echo;
  const auto tracer = static_cast<const Integrator&>(echo).tracer(world);
  PathBundle bundle{.sampler = *sampler, .dimension = 2, .samples = {7, 8, 32, PathBundle::kSize}};
  bundle.lanes = 0xffff, bundle.wanted = 0x8101;
  for (size_t i = 0; i < PathBundle::kSize; ++i) {
    bundle.rays[i].o.x = float(i);
    bundle.keys[i] = 100 + i;
    bundle.results[i].scatterings = -1;
  }
  tracer->trace(bundle);
  EXPECT_EQ(bundle.traced, 9u);
  for (size_t i = 0; i < PathBundle::kSize; ++i) {
    const PathResult& result = bundle.results[i];
    if (i != 0 && i != 8 && i != 15) {
      EXPECT_EQ(result.scatterings, -1);
      continue;
    }
    SampleNumbers numbers(*sampler, 7, 8, 32 + i, 2);
    EXPECT_EQ(result.radiance[0], numbers.get1d());
    EXPECT_EQ(result.radiance[1], numbers.get2d().y);
    EXPECT_EQ(result.radiance[2], float(i));
    EXPECT_EQ(result.scatterings, 100 + int(i));
  }
}

}  // namespace
}  // namespace frond
