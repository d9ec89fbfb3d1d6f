#include "radiometry/incident_light.h"

#include <cmath>
#include <numbers>

#include "core/emission.h"
#include "core/math/sampling.h"

namespace frond {
namespace {

/// Cosine below which light is left out: its ray would begin far from the scene, or nowhere. Of a uniform sky this is
/// 1e-12 of the light, of a cosine that is rounded to 0 about 1e-7.
constexpr float kGrazing = 1e-6f;

/// Returns the point as floats below 1.
Vec2 to_floats(const UnitPoint& u) {
  constexpr float kBelowOne = 1 - 0x1p-24f;
  return {std::min(float(u[0]), kBelowOne), std::min(float(u[1]), kBelowOne)};
}

std::optional<LightSample> sample_from_above(const Light& light, Vec2 u, const SampledWavelengths& lambda) {
  const auto s = light.sample({}, u, lambda);
  if (!s || s->wi.z < kGrazing || s->pdf <= 0) return {};
  return s;
}

/// Returns whether the weights of directions sampled with the cosine have less variance than those of the light's own
/// samples. Both second moments, of the same mean, are estimated from the light's samples: directions sampled with the
/// cosine would hardly ever hit a sun, and show less variance than they have.
bool varies_less_by_cosine(const Light& light, const SampledWavelengths& lambda) {
  constexpr int kPoints = 4096;
  RandomStream random(1);
  double by_cosine = 0, own = 0;
  for (int i = 0; i < kPoints; ++i) {
    const auto s = sample_from_above(light, {random.uniform(), random.uniform()}, lambda);
    if (!s) continue;
    const double radiance = double(s->radiance[0]), weight = radiance * double(s->wi.z) / double(s->pdf);
    by_cosine += weight * radiance * std::numbers::pi;
    own += weight * weight;
  }
  return by_cosine < own;
}

/// Samples one light; the weight is relative to the irradiance of all lights. `sky`: the light, to be sampled with the
/// cosine, or nullptr.
std::optional<IncidentLight::Sample> sample_light(const Light& light, const EnvironmentLight* sky, Vec2 u,
                                                  const SampledWavelengths& lambda) {
  if (sky) {
    const Vec3 wi = sample_cosine_hemisphere(u);
    if (wi.z < kGrazing) return {};
    return IncidentLight::Sample{-wi, sky->radiance({}, wi, lambda) * kPi};
  }
  const auto s = sample_from_above(light, u, lambda);
  if (!s) return {};
  return IncidentLight::Sample{-s->wi, s->radiance * (s->wi.z / s->pdf)};
}

}  // namespace

IncidentLight::IncidentLight(const Scene& scene, HorizontalIrradiance irradiance, const SampledWavelengths& lambda)
    : lights_(scene.lights()), irradiance_(std::move(irradiance)) {
  for (const Light* light : lights_) {
    const auto* sky = dynamic_cast<const EnvironmentLight*>(light);
    cosine_sampled_.push_back(sky && varies_less_by_cosine(*light, lambda) ? sky : nullptr);
  }
}

std::optional<IncidentLight::Sample> IncidentLight::sample(UnitPoint place, RandomStream& random,
                                                           const SampledWavelengths& lambda) const {
  const std::vector<double>& shares = irradiance_.shares();
  size_t i = 0;
  while (i + 1 < shares.size() && place[0] >= shares[i]) place[0] -= shares[i++];
  place[0] /= shares[i];
  const Vec2 u{random.uniform(), random.uniform()};
  std::optional<Sample> s;
  if (const auto* lamp = lights_[i]->is_distant() ? nullptr : dynamic_cast<const EmissionSampler*>(lights_[i])) {
    const auto ray = lamp->sample_emission(to_floats(place), u, lambda);
    if (ray) s = Sample{ray->direction, ray->power, false, ray->origin};
  } else {
    s = sample_light(*lights_[i], cosine_sampled_[i], u, lambda);
    if (s) s->weight *= SampledSpectrum(float(irradiance_.area()));
  }
  if (!s) return {};
  SampledSpectrum weight;
  const SampledSpectrum irradiance = irradiance_.at(lambda);
  for (int lane = 0; lane < lambda.count; ++lane)
    if (irradiance[lane] > 0) weight[lane] = s->weight[lane] / (float(shares[i]) * irradiance[lane]);
  return Sample{s->direction, weight, !s->origin && frond::is_direct(*lights_[i], -s->direction), s->origin, place};
}

EntryBox::Point EntryBox::sample(const Vec3d& d, UnitPoint u) const {
  const Target& t = target;
  const double y = std::lerp(t.y0, t.y1, u[1]);
  if (!bottom) return {{std::lerp(t.x0, t.x1, u[0]), y, t.z}};
  const double width = t.x1 - t.x0, depth = t.y1 - t.y0, height = t.z - *bottom;
  const double top = width * depth, along_x = depth * height * std::abs(d.x / d.z),
               along_y = width * height * std::abs(d.y / d.z), all = top + along_x + along_y;
  const auto weight = float(all / top);
  double at = u[0] * all;  // along the faces side by side
  if (at < top) return {{std::lerp(t.x0, t.x1, at / top), y, t.z}, weight};
  at -= top;
  if (at < along_x || along_y == 0) return {{d.x > 0 ? t.x0 : t.x1, y, std::lerp(*bottom, t.z, at / along_x)}, weight};
  const double x = std::lerp(t.x0, t.x1, (at - along_x) / along_y);
  return {{x, d.y > 0 ? t.y0 : t.y1, std::lerp(*bottom, t.z, u[1])}, weight};
}

}  // namespace frond
