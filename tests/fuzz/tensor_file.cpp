// Measured BSDFs.

#include "system/tensor_file.h"

#include "core/arena.h"
#include "materials/measured/measured_data.h"
#include "tests/fuzz/fuzz.h"

using namespace frond;

FROND_FUZZ_TARGET(tensor_file, bytes) {
  fuzz::accepts([&] {
    const TensorFile file(std::string(bytes), "file", {});
    for (const TensorFile::Field& field : file.fields()) {
      fuzz::require(field.bytes.size() <= bytes.size(), "a field is inside the file");
      fuzz::require(field.count <= bytes.size(), "a number takes a byte or more");
    }
  });
  std::unique_ptr<MeasuredData> data;
  if (!fuzz::accepts([&] { data = read_tensor_brdf(std::string(bytes), "file", {}); })) return;
  SampledWavelengths lambda;
  lambda.nm = {400, 500, 600, 700}, lambda.active = {true, true, true, true}, lambda.count = kLanes;
  Arena arena;
  const Bsdf& bsdf = *data->bsdf(lambda, arena);
  RandomStream rng(1);
  for (const float u : {0.f, 0.3f, 0.9999f}) {
    const Vec3 wo = normalize(Vec3{u - 0.5f, 0.2f, 0.1f + u});
    if (const auto s = bsdf.sample(wo, u, {u, 1 - u}, rng)) fuzz::require(s->wi.z > 0, "a sample is above the surface");
  }
}
