#include "leaf/walk/walk.h"

#include "core/stop.h"
#include "leaf/walk/walker.h"

namespace frond::leaf {
namespace {

template <size_t K>
struct End {
  Fate fate;
  Vec3d wi;
  std::array<double, K> weights;
};

template <size_t K>
End<K> walk_lanes(const std::array<const Tissue*, K>& tissues, size_t hero, const Vec3d& wo, Absorption absorption,
                  const FirstEvent& first, RandomStream& rng) {
  Walker<K> ray(tissues, hero, wo, absorption, rng);
  const auto surface = ray.next_crossings();
  const bool enters = first.branch >= surface[hero].reflectance;
  const double r2 = first.x * first.x + first.y * first.y;
  const DiskPoint p = r2 > 0 ? DiskPoint{first.x, first.y, r2} : sample_disk(rng);
  ray.scatter(enters, surface, p, kNoConnection);
  if (!enters) return {Fate::surface, ray.direction(), ray.weights()};
  for (StopPoll poll; ray.inside(); poll())  // long where next to nothing is absorbed
    if (!ray.step(kNoConnection)) return {Fate::absorbed, ray.direction(), {}};

  ray.leave();
  const bool same_side = ray.up() == (wo.z > 0);
  return {same_side ? Fate::reflected : Fate::transmitted, ray.direction(), ray.weights()};
}

template <size_t K>
std::array<double, K> estimate_subsurface_f_lanes(const std::array<const Tissue*, K>& tissues, size_t hero,
                                                  const Vec3d& wo, const Vec3d& wi, Absorption absorption,
                                                  RandomStream& rng) {
  const bool exits_up = wi.z > 0;
  const size_t exit_medium = exits_up ? 1 : 5;
  std::array<Vec3d, K> inner;
  std::array<double, K> factor, sum{};
  for (size_t i = 0; i < K; ++i) {
    const double n = tissues[i]->n_cuticle();
    const InnerDirection direction(wi, n);
    inner[i] = direction.w;
    factor[i] = direction.factor(n);
  }
  Walker<K> ray(tissues, hero, wo, absorption, rng);
  const auto connect = [&](const Lobe& lobe) {
    if (ray.medium() != exit_medium || ray.up() != exits_up) return;
    const auto weights = ray.weights();
    for (size_t i = 0; i < K; ++i)
      if (weights[i] > 0) sum[i] += weights[i] * Walker<K>::lobe_density(lobe, ray.axis(i), inner[i]);
  };
  if (!ray.enter(ray.next_crossings(), sample_disk(rng), connect)) return {};
  for (StopPoll poll; ray.inside() && ray.step(connect);) poll();
  for (size_t i = 0; i < K; ++i) sum[i] *= factor[i];
  return sum;
}

/// Calls `act` with the tissues as an std::array of their number.
template <class Act>
auto with_lanes(std::span<const Tissue* const> tissues, const Act& act) {
  const auto first = [&]<size_t K>(std::integral_constant<size_t, K>) {
    std::array<const Tissue*, K> lanes;
    std::copy_n(tissues.begin(), K, lanes.begin());
    return act(lanes);
  };
  switch (tissues.size()) {
    case 1:
      return first(std::integral_constant<size_t, 1>());
    case 2:
      return first(std::integral_constant<size_t, 2>());
    case 3:
      return first(std::integral_constant<size_t, 3>());
    default:
      assert(tissues.size() == 4);
      return first(std::integral_constant<size_t, 4>());
  }
}

template <size_t K>
LaneValues in_lanes(const std::array<double, K>& values) {
  LaneValues result{};
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

}  // namespace

WalkEnd walk(const Tissue& tissue, const Vec3d& wo, Absorption absorption, const FirstEvent& first, RandomStream& rng) {
  const auto end = walk_lanes<1>({&tissue}, 0, wo, absorption, first, rng);
  return {end.fate, end.wi, end.weights[0]};
}

WalkEnd walk(const Tissue& tissue, const Vec3d& wo, Absorption absorption, RandomStream& rng) {
  const double branch = rng.uniform_double();
  const DiskPoint p = sample_disk(rng);
  return walk(tissue, wo, absorption, {branch, p.x, p.y}, rng);
}

SpectralWalkEnd walk(std::span<const Tissue* const> tissues, size_t hero, const Vec3d& wo, Absorption absorption,
                     const FirstEvent& first, RandomStream& rng) {
  return with_lanes(tissues, [&](const auto& lanes) -> SpectralWalkEnd {
    const auto end = walk_lanes(lanes, hero, wo, absorption, first, rng);
    return {end.fate, end.wi, in_lanes(end.weights)};
  });
}

double surface_reflectance(const Tissue& tissue, double cos_theta) {
  return fresnel(std::abs(cos_theta), 1 / tissue.n_cuticle()).reflectance;
}

double surface_f(const Tissue& tissue, const Vec3d& wo, const Vec3d& wi) {
  if (wo.z * wi.z <= 0) return 0;
  const Vec3d mirror{-wo.x, -wo.y, wo.z};
  const Lobe& lobe = tissue.surface_lobe();
  return surface_reflectance(tissue, wo.z) * lobe.density(dot(mirror, wi)) /
         (lobe.kept_share(std::abs(wo.z)) * std::abs(wi.z));
}

double estimate_subsurface_f(const Tissue& tissue, const Vec3d& wo, const Vec3d& wi, Absorption absorption,
                             RandomStream& rng) {
  return estimate_subsurface_f_lanes<1>({&tissue}, 0, wo, wi, absorption, rng)[0];
}

LaneValues estimate_subsurface_f(std::span<const Tissue* const> tissues, size_t hero, const Vec3d& wo, const Vec3d& wi,
                                 Absorption absorption, RandomStream& rng) {
  return with_lanes(tissues, [&](const auto& lanes) {
    return in_lanes(estimate_subsurface_f_lanes(lanes, hero, wo, wi, absorption, rng));
  });
}

}  // namespace frond::leaf
