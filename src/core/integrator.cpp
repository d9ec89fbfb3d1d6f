#include "core/integrator.h"

namespace frond {
namespace {

class OnePathTracer final : public Tracer {
 public:
  OnePathTracer(const OnePathIntegrator& integrator, const World& world) : integrator_(integrator), world_(world) {}

  void trace(PathBundle& bundle) override {
    const PixelSamples& s = bundle.samples;
    for (size_t i = 0; i < PathBundle::kSize; ++i) {
      if (!(bundle.wanted >> i & 1)) continue;
      const SampleNumbers numbers(bundle.sampler, s.x, s.y, s.first + i, bundle.dimension);
      PathContext context{numbers, bundle.keys[i], arena_};
      bundle.results[i] = integrator_.trace(world_, bundle.rays[i], bundle.lambda[i], context);
      bundle.traced += context.rays;
    }
  }

 private:
  const OnePathIntegrator& integrator_;
  const World& world_;
  Arena arena_;
};

}  // namespace

std::unique_ptr<Tracer> OnePathIntegrator::tracer(const World& world) const {
  return std::make_unique<OnePathTracer>(*this, world);
}

}  // namespace frond
