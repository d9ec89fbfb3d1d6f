#include "instruments/beam.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/bssrdf.h"
#include "core/math/sampling.h"

namespace frond {

Vec3 toward_light(const Beam& beam) {
  constexpr float kGrazing = 1e-7f;
  if (beam.theta_deg == 90) return {1, 0, kGrazing};
  const double theta = beam.theta_deg * std::numbers::pi / 180;
  return {static_cast<float>(std::sin(theta)), 0, static_cast<float>(std::cos(theta))};
}

void check_beam(const Beam& beam) {
  if (!(beam.theta_deg >= 0 && beam.theta_deg <= 180))
    fail({}, "the angle of incidence goes from 0 to 180 degrees, {} was given", beam.theta_deg);
  if (!(beam.lambda_nm > 0 && std::isfinite(beam.lambda_nm)))
    fail({}, "a wavelength is a positive number of nanometres, {} was given", beam.lambda_nm);
}

void check_rays(int64_t rays) {
  if (rays < 2) fail({}, "a measurement takes 2 rays at least, for its standard error; {} were asked for", rays);
}

Hit flat_hit() {
  Hit hit;
  hit.ng = {0, 0, 1};
  hit.shading = Frame::around(hit.ng);
  hit.at.uv = {0.5f, 0.5f};
  return hit;
}

std::string label_of(const Beam& beam) {
  if (beam.emission_nm > 0) return fmt::format("{:g} to {:g} nm", beam.lambda_nm, beam.emission_nm);
  return beam.band ? beam.band->name : fmt::format("{:g} nm", beam.lambda_nm);
}

const Bsdf& bsdf_of(const Material& material, const Beam& beam, Arena& arena) {
  return bsdf_at(material, beam.band ? beam.band->lit_response.sample(0.5f) : float(beam.lambda_nm), arena);
}

const Bsdf& bsdf_at(const Material& material, float lambda_nm, Arena& arena) {
  if (dynamic_cast<const SubsurfaceMaterial*>(&material))
    fail({}, "the material scatters light under its surface, which no BSDF describes: render a body of it");
  const Bsdf* bsdf = material.evaluate(flat_hit(), OneWavelength(double(lambda_nm)).sample(0), arena);
  if (!bsdf) fail({}, "the material has no surface there: nothing can be measured");
  return *bsdf;
}

void scatter_as_rendered(const Bsdf& bsdf, const Vec3& light, RandomStream& rng, std::span<Scattered> rays) {
  for (Scattered& ray : rays) {
    const float u = rng.uniform(), v = rng.uniform();
    Vec3 seen = sample_cosine_hemisphere({u, v});
    const bool front = rng.uniform() < 0.5f;
    if (!front) seen.z = -seen.z;
    const Lobes side = same_side(seen, light) ? Lobes::reflection : Lobes::transmission;
    ray = {seen, side | Lobes::diffuse, {}};
    if (seen.z != 0) ray.weight = bsdf.f(seen, light, rng) * (2 * kPi);
  }
}

void check_as_rendered(const LitMaterial& lit) {
  if (!lit.as_rendered) return;
  Arena arena;
  if (any(bsdf_of(lit.material, lit.beam, arena).flags() & Lobes::specular))
    fail({}, "the material has a delta lobe, which can be measured only along the model's own incident direction");
}

SampledWavelengths OneWavelength::sample(float) const {
  SampledWavelengths lambda;
  lambda.count = 1;
  lambda.nm[0] = nm_;
  lambda.pdf[0] = 1;
  lambda.active[0] = true;
  return lambda;
}

SensorResponse OneWavelength::sensor(const SampledSpectrum& radiance, const SampledWavelengths&) const {
  return std::array{double(radiance[0]), double(radiance[0]), double(radiance[0])};
}

}  // namespace frond
