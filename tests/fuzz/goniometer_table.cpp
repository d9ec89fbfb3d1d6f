// Tables of a goniometer.

#include "core/arena.h"
#include "materials/measured/measured_data.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(goniometer_table, bytes) {
  std::unique_ptr<MeasuredData> data;
  if (!fuzz::accepts([&] { data = read_goniometer_table(bytes, "file"); })) return;
  SampledWavelengths lambda;
  lambda.nm = {400, 500, 600, 700}, lambda.active = {true, true, true, true}, lambda.count = kLanes;
  data->prepare({400, 700});
  Arena arena;
  const Bsdf& bsdf = *data->bsdf(lambda, arena);
  RandomStream rng(1);
  for (const float u : {0.f, 0.3f, 0.9999f})
    for (const float z : {-0.8f, 0.f, 0.1f}) {
      const Vec3 wo = normalize(Vec3{u - 0.5f, 0.2f, z});
      const auto s = bsdf.sample(wo, u, {u, 1 - u}, rng);
      fuzz::require(!s || (s->pdf > 0 && s->f.is_physical()), "a sample has a density and a value");
    }
}
