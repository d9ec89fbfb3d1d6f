#include "core/bsdf.h"

#include <cassert>
#include <cmath>

namespace frond {
namespace {

/// Samples a direction with wo = `incident`. If the model's incident direction is wi, `f` is evaluated with the two
/// directions exchanged, and `sample` serves only as importance sampling.
Scattered scatter_one(const Bsdf& bsdf, bool from_light, const Vec3& incident, RandomStream& rng) {
  const float uc = rng.uniform(), u = rng.uniform(), v = rng.uniform();
  const auto s = bsdf.sample(incident, uc, {u, v}, rng);
  if (!s) return {};
  const bool turn_round = from_light && !any(s->flags & Lobes::specular);
  assert(!turn_round || !s->pdf_is_approximate);
  const SampledSpectrum f = turn_round ? bsdf.f(s->wi, incident, rng) : s->f * radiance_to_power(bsdf, incident, s->wi);
  return {s->wi, s->flags, f * (std::abs(s->wi.z) / s->pdf)};
}

}  // namespace

void Bsdf::scatter(const Vec3& incident, RandomStream& rng, std::span<Scattered> rays) const {
  const bool from_light = any(flags() & Lobes::from_light);
  for (Scattered& ray : rays) ray = scatter_one(*this, from_light, incident, rng);
}

}  // namespace frond
