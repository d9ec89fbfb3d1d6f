// Text of --wavelengths: a strategy with parameters.

#include "render/plugins.h"
#include "scene/overrides.h"
#include "scene/scene.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

static void check(const WavelengthStrategy& strategy) {
  const Interval range = strategy.range_nm();
  fuzz::require(std::isfinite(range.min) && std::isfinite(range.max) && range.min <= range.max, "the range is finite");
  fuzz::require(strategy.bands().empty() != strategy.film_space().empty(), "the film has colours or bands");
  for (uint64_t i = 0; i < 16; ++i) {
    const SampledWavelengths lambda = strategy.sample_for_index(i, (float(i) + 0.5f) / 16);
    fuzz::require_finite(lambda.nm, "a wavelength");
    fuzz::require_finite(lambda.pdf, "a density");
    const SensorResponse response = strategy.sensor(SampledSpectrum(1), lambda);
    fuzz::require_finite(response.value, "a response");
  }
}

FROND_FUZZ_TARGET(wavelengths, bytes) {
  static const Registry registry = builtin_registry();
  (void)fuzz::folder();
  fuzz::accepts([&] {
    SceneDescription scene;
    apply_overrides({.wavelengths = std::string(bytes)}, scene, registry, silent_log());
    check(*make_wavelengths(scene, registry));
  });
}
