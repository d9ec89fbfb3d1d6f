#include "materials/measured/goniometer_bsdf.h"

#include <cmath>

#include "core/math/sampling.h"
#include "materials/lobes/active_lanes.h"

namespace frond {
namespace {

/// Angle from the nearer pole.
float polar_angle(const Vec3& w) { return std::atan2(std::hypot(w.x, w.y), std::abs(w.z)); }

/// Unit vector along the azimuth of wo; the x axis at the pole.
Vec2 azimuth(const Vec3& wo) {
  const float length = std::hypot(wo.x, wo.y);
  return length > 0 ? Vec2{wo.x / length, wo.y / length} : Vec2{1, 0};
}

/// The incidence's two slices and their weights.
struct Slices {
  std::array<size_t, 2> slice;
  std::array<float, 2> weight;
  size_t count;

  Slices(const GoniometerFace& face, const Vec3& wo) {
    const auto [below, t] = cell_of(face.incidence, polar_angle(wo));
    slice = {below, below + 1};
    weight = {1 - t, t};
    count = t > 0 ? 2 : 1;
  }
  /// Weighted totals of a grid.
  std::array<float, 2> totals(const DirectionGrid& grid) const {
    std::array<float, 2> totals{};
    for (size_t k = 0; k < count && !grid.empty(); ++k) totals[k] = weight[k] * grid.total(slice[k]);
    return totals;
  }
};

DirectionGrid::Place place(const DirectionGrid& grid, const Vec3& wo, const Vec3& wi) {
  const Vec2 a = azimuth(wo);
  return grid.place(polar_angle(wi), std::atan2(a.x * wi.y - a.y * wi.x, a.x * wi.x + a.y * wi.y));
}

}  // namespace

GoniometerBsdf::GoniometerBsdf(const std::array<GoniometerFace, 2>& front_back, std::span<const float> wavelengths_nm,
                               const SampledWavelengths& lambda)
    : faces_(front_back), lanes_(cells_of(wavelengths_nm, lambda)), mask_(lane_mask(lambda)) {}

Lobes GoniometerBsdf::flags() const {
  Lobes flags = Lobes::glossy;
  for (const GoniometerFace& face : faces_) {
    if (!face.reflected.empty()) flags = flags | Lobes::reflection;
    if (!face.transmitted.empty()) flags = flags | Lobes::transmission;
  }
  return flags;
}

SampledSpectrum GoniometerBsdf::f(const Vec3& wo, const Vec3& wi, RandomStream&) const {
  if (wo.z * wi.z == 0 || grid(wo, wi).empty()) return {};
  const DirectionGrid& g = grid(wo, wi);
  const DirectionGrid::Place at = place(g, wo, wi);
  const Slices slices(lit_face(wo), wo);
  SampledSpectrum sum;
  for (size_t k = 0; k < slices.count; ++k) sum += g.value(slices.slice[k], at, lanes_) * slices.weight[k];
  return sum * mask_;
}

float GoniometerBsdf::pdf(const Vec3& wo, const Vec3& wi) const {
  if (wo.z * wi.z == 0 || grid(wo, wi).empty()) return 0;
  const DirectionGrid& g = grid(wo, wi);
  const DirectionGrid::Place at = place(g, wo, wi);
  const Slices slices(lit_face(wo), wo);
  const auto r = slices.totals(lit_face(wo).reflected), t = slices.totals(lit_face(wo).transmitted);
  const float total = r[0] + r[1] + t[0] + t[1];
  float density = 0;
  for (size_t k = 0; k < slices.count; ++k) density += slices.weight[k] * g.density(slices.slice[k], at);
  return total > 0 ? density * std::abs(wi.z) / total : 0;
}

std::optional<BsdfSample> GoniometerBsdf::sample(const Vec3& wo, float, Vec2 u, RandomStream& rng) const {
  if (wo.z == 0) return {};
  const GoniometerFace& face = lit_face(wo);
  const Slices slices(face, wo);
  const auto r = slices.totals(face.reflected), t = slices.totals(face.transmitted);
  // One number chooses the hemisphere and the incidence, and then samples it.
  const std::array<float, 4> totals{r[0], r[1], t[0], t[1]};
  const float all = r[0] + r[1] + t[0] + t[1];
  if (!(all > 0)) return {};
  size_t chosen = 0;
  float begin = 0, end = totals[0] / all;
  for (size_t next = 1; next < 4 && u.x >= end; ++next)
    if (totals[next] > 0) chosen = next, begin = end, end += totals[next] / all;
  const bool reflects = chosen < 2;
  const DirectionGrid& g = reflects ? face.reflected : face.transmitted;
  const auto [theta, phi] =
      g.sample(slices.slice[chosen % 2], {std::clamp(remap_sample(u.x, begin, end), 0.f, 1.f), u.y});
  const Vec2 a = azimuth(wo);
  const float sine = std::sin(theta), x = std::cos(phi), y = std::sin(phi);
  const float z = std::cos(theta) * ((wo.z > 0) == reflects ? 1.f : -1.f);
  const Vec3 wi{sine * (a.x * x - a.y * y), sine * (a.y * x + a.x * y), z};
  const float density = pdf(wo, wi);
  if (!(density > 0)) return {};
  return BsdfSample{f(wo, wi, rng), wi, density, Lobes::glossy | (reflects ? Lobes::reflection : Lobes::transmission)};
}

}  // namespace frond
