#include "instruments/goniophotometer.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/math/vec.h"
#include "instruments/cubature.h"

namespace frond {
namespace {

struct PatchTally {
  const DetectorSphere* sphere;
  std::vector<Moments> caught;

  void add(const Scattered& ray) {
    if (const float weight = ray.weight[0]; weight != 0) caught[sphere->find(ray.direction)].add(double(weight));
  }
  void add(const PatchTally& other) {
    for (size_t i = 0; i < caught.size(); ++i) caught[i].add(other.caught[i]);
  }
  void clear() { caught.assign(caught.size(), {}); }
};

SphereBox box_of(const Patch& p) {
  return {std::cos(p.theta_max_deg * kDegree), std::cos(p.theta_min_deg * kDegree), p.phi_min_deg * kDegree,
          p.phi_max_deg * kDegree};
}

/// Evaluates f |cos theta| of a material with an exact f, for one thread.
class ShareDensity {
 public:
  explicit ShareDensity(const LitMaterial& lit)
      : bsdf_(bsdf_of(lit.material, lit.beam, arena_)),
        light_(toward_light(lit.beam)),
        detector_is_wo_(lit.as_rendered || any(bsdf_.flags() & Lobes::from_light)) {}

  double operator()(const Vec3& detector) const {
    RandomStream unused(0);
    const SampledSpectrum f = detector_is_wo_ ? bsdf_.f(detector, light_, unused) : bsdf_.f(light_, detector, unused);
    // No cubature would settle.
    if (!(f[0] >= 0 && f[0] < INFINITY))
      fail({}, "the material has a defect: its f is {} toward ({}, {}, {}), and must be finite and not negative", f[0],
           detector.x, detector.y, detector.z);
    return static_cast<double>(f[0] * std::abs(detector.z));
  }

 private:
  Arena arena_;
  const Bsdf& bsdf_;
  Vec3 light_;
  bool detector_is_wo_;
};

/// The directions that lie in the box, with their azimuths in the box's range.
std::vector<SpherePoint> points_in(const SphereBox& box, std::span<const SpherePoint> points) {
  std::vector<SpherePoint> result;
  for (SpherePoint p : points) {
    if (p.phi >= box.phi1) p.phi -= 2 * std::numbers::pi;
    if (p.cos_theta >= box.z0 && p.cos_theta < box.z1 && p.phi >= box.phi0) result.push_back(p);
  }
  return result;
}

Lobes flags_of(const LitMaterial& lit) {
  Arena arena;
  return bsdf_of(lit.material, lit.beam, arena).flags();
}

Estimate scaled(const Estimate& e, double scale) {
  return {e.mean * scale, e.variance * scale * scale, e.third_cumulant * scale * scale * scale};
}

/// Mean of f over a patch, with directions uniform in the projected solid angle: the square of the cosine is uniform.
Estimate mean_f(const Density& f, const SphereBox& box, int64_t rays, RandomStream& rng) {
  Moments moments;
  for (int64_t i = 0; i < rays; ++i) {
    const double z = std::sqrt(std::lerp(box.z0 * box.z0, box.z1 * box.z1, rng.uniform_double()));
    moments.add(
        f(sphere_direction(std::copysign(z, box.z0 + box.z1), std::lerp(box.phi0, box.phi1, rng.uniform_double()))));
  }
  return moments.estimate();
}

}  // namespace

Estimate GoniophotometerMeasurement::f(size_t patch) const {
  if (!fluorescence.empty()) return fluorescence[patch];
  const double scale = 1 / sphere.patch(patch).projected_solid_angle;
  if (is_integrated()) return {integral[patch] * scale, 0, 0};
  Moments all = caught[patch];
  all.add_zeros(rays - all.count());
  return scaled(all.estimate(), scale);
}

Estimate GoniophotometerMeasurement::share(bool reflected) const {
  double integrated = 0;
  Moments all;
  Estimate emitted;
  for (size_t i = 0; i < sphere.size(); ++i) {
    if (is_reflected(sphere.patch(i)) != reflected) continue;
    const double projected = sphere.patch(i).projected_solid_angle;
    if (!fluorescence.empty())
      emitted += scaled(fluorescence[i], projected);
    else if (is_integrated())
      integrated += integral[i];
    else
      all.add(caught[i]);
  }
  if (!fluorescence.empty()) return emitted;
  if (is_integrated()) return {integrated, 0, 0};
  all.add_zeros(rays - all.count());
  return all.estimate();
}

void check_no_delta_lobe(const LitMaterial& lit) {
  if (any(flags_of(lit) & Lobes::specular))
    fail({},
         "the material has a delta lobe, whose f no detector of finite size can measure; frond spectrophotometer "
         "measures its share of the light");
}

GoniophotometerMeasurement measure_f(const LitMaterial& lit, const DetectorSphere& sphere, int64_t rays,
                                     const ThreadPool& pool, const RayProgress& progress) {
  check_beam(lit.beam);
  check_rays(rays);
  check_as_rendered(lit);
  check_no_delta_lobe(lit);
  GoniophotometerMeasurement measurement{lit.beam, sphere, rays, {}, {}};
  PatchTally tally{&sphere, std::vector<Moments>(sphere.size())};
  tally_rays(lit, 0, rays, tally, pool, progress);
  measurement.caught = std::move(tally.caught);
  return measurement;
}

bool has_exact_f(const LitMaterial& lit) { return !any(flags_of(lit) & Lobes::stochastic); }

GoniophotometerMeasurement integrate_f(const LitMaterial& lit, const DetectorSphere& sphere, const ThreadPool& pool) {
  assert(has_exact_f(lit));
  check_beam(lit.beam);
  check_no_delta_lobe(lit);
  const Vec3 light = toward_light(lit.beam);
  const std::array peaks{SpherePoint({-light.x, -light.y, light.z}), SpherePoint(-light)};
  GoniophotometerMeasurement measurement{lit.beam, sphere, 0, {}, std::vector<double>(sphere.size())};
  pool.for_each(sphere.thetas(), [&](int64_t row, int) {
    const ShareDensity density(lit);
    for (int column = 0; column < sphere.phis(); ++column) {
      check_stop();
      const size_t i = sphere.index(static_cast<int>(row), column);
      const SphereBox box = box_of(sphere.patch(i));
      constexpr double kNegligible = 1e-12;
      measurement.integral[i] = total(integrate(box, std::ref(density), kNegligible, points_in(box, peaks)));
    }
  });
  return measurement;
}

GoniophotometerMeasurement measure_fluorescence_f(const Fluorescence& fluorescence, const Beam& beam,
                                                  const DetectorSphere& sphere, int64_t rays, uint64_t seed,
                                                  const ThreadPool& pool) {
  check_beam(beam);
  const int64_t each = rays / static_cast<int64_t>(sphere.size());
  if (fluorescence.is_noisy() && each < 2)
    fail({}, "{} rays are fewer than 2 for each of {} patches, which a standard error needs", rays, sphere.size());
  const Vec3 light = toward_light(beam);
  GoniophotometerMeasurement measurement{beam, sphere, 0, {}, {}};
  if (fluorescence.is_noisy()) measurement.rays = each * static_cast<int64_t>(sphere.size());
  measurement.fluorescence.resize(sphere.size());
  pool.for_each(static_cast<int64_t>(sphere.size()), [&](int64_t index, int) {
    check_stop();
    const auto i = static_cast<size_t>(index);
    const Patch patch = sphere.patch(i);
    const SphereBox box = box_of(patch);
    RandomStream rng(hash_key(seed, i, std::bit_cast<uint64_t>(beam.theta_deg), std::bit_cast<uint64_t>(beam.lambda_nm),
                              std::bit_cast<uint64_t>(beam.emission_nm)));
    const auto f = [&](const Vec3& w) { return fluorescence.f(w, light, beam.emission_nm, beam.lambda_nm, rng); };
    const auto f_cos = [&](const Vec3& w) { return f(w) * std::abs(double(w.z)); };
    measurement.fluorescence[i] = fluorescence.is_noisy()
                                      ? mean_f(f, box, each, rng)
                                      : Estimate{total(integrate(box, f_cos, 0)) / patch.projected_solid_angle, 0, 0};
  });
  return measurement;
}

}  // namespace frond
