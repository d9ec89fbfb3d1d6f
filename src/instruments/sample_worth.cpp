#include "instruments/sample_worth.h"

#include <array>
#include <bit>
#include <numbers>
#include <vector>

#include "core/math/sampling.h"
#include "core/math/vec.h"
#include "instruments/beam.h"
#include "instruments/bsdf_calls.h"

namespace frond {
namespace {

/// Sample of a light: direction, radiance and density.
struct TowardLight {
  Vec3 w;
  float radiance, pdf;
};

/// Point of the horizontal circle at this height; phi in turns.
Vec3 spherical_direction(float cosine, float sine, float turns) {
  return {sine * std::cos(2 * kPi * turns), sine * std::sin(2 * kPi * turns), cosine};
}

// Both lights give the irradiance pi on the front and are sampled in proportion to radiance.

class OvercastSky {
 public:
  TowardLight sample(Vec2 u) const {
    const float cosine = (std::sqrt(1 + 8 * u.x) - 1) / 2;  // (c + c^2) / 2 = u
    return shining(spherical_direction(cosine, std::sqrt(std::max(0.f, 1 - cosine * cosine)), u.y));
  }
  TowardLight at(const Vec3& w) const { return w.z > 0 ? shining(w) : TowardLight{w, 0, 0}; }

 private:
  static TowardLight shining(const Vec3& w) { return {w, 3.f / 7 * (1 + 2 * w.z), (1 + 2 * w.z) * kInvPi / 4}; }
};

class SunDisc {
 public:
  TowardLight sample(Vec2 u) const {
    const float square = u.x * chord_ * chord_;  // square of the chord from the centre: uniform in area
    const Vec3 w = spherical_direction(1 - square / 2, std::sqrt(square * (1 - square / 4)), u.y);
    return {frame_.to_world(w), radiance_, pdf_};
  }
  TowardLight at(const Vec3& w) const {
    if (length(w - frame_.z) > chord_) return {w, 0, 0};
    return {w, radiance_, pdf_};
  }

 private:
  static inline const double kCosine = std::cos(kSunZenith_deg * kDegree);
  static inline const double kChord = 2 * std::sin(kSunRadius_deg * kDegree / 2);
  static inline const double kSolidAngle = std::numbers::pi * kChord * kChord;
  static inline const double kMeanCosine = kCosine * (1 - kChord * kChord / 4);

  Frame frame_ = Frame::around({0, static_cast<float>(std::sqrt(1 - kCosine * kCosine)), static_cast<float>(kCosine)});
  float chord_ = static_cast<float>(kChord);
  float pdf_ = static_cast<float>(1 / kSolidAngle);
  float radiance_ = static_cast<float>(std::numbers::pi / (kSolidAngle * kMeanCosine));
};

/// Moments of one estimate, by lane.
struct LaneMoments {
  std::array<Moments, kLanes> lanes;

  void add(const SampledSpectrum& x) {
    for (size_t i = 0; i < kLanes; ++i) lanes[i].add(double(x.v[i]));
  }
};

/// Moments over batches of their means and variances, each averaged over the lanes in use.
struct BatchMoments {
  Moments mean, variance;

  void add(const LaneMoments& batch, int lanes) {
    double m = 0, v = 0;
    for (size_t i = 0; i < static_cast<size_t>(lanes); ++i) m += batch.lanes[i].mean(), v += batch.lanes[i].variance();
    mean.add(m / lanes);
    variance.add(v / lanes);
  }
  Worth worth() const { return {mean.estimate(), variance.estimate()}; }
};

struct Batch {
  LaneMoments albedo, sky, sun;
};

/// A specimen under both lights, for one thread at a time.
class LitSpecimen {
 public:
  explicit LitSpecimen(const PathHit& hit)
      : bsdf_(hit.material.evaluate(flat_hit(), hit.lambda, arena_)), wo_(view_direction(hit.theta_deg)) {
    if (!bsdf_) fail({}, "the material has no surface there: nothing can be measured");
  }

  void add_to(Batch& batch, RandomStream& rng) const {
    const PathVertex vertex = add_lit(OvercastSky(), rng, batch.sky);
    batch.albedo.add(vertex.weight);
    add_lit(sun_, rng, batch.sun);
  }

 private:
  template <class Light>
  PathVertex add_lit(const Light& light, RandomStream& rng, LaneMoments& moments) const {
    const auto square = [&rng] {
      const float x = rng.uniform();
      return Vec2{x, rng.uniform()};
    };
    const TowardLight chosen = light.sample(square());
    const float uc = rng.uniform();
    const Vec2 u = square();
    RandomStream own(rng.bits());
    const PathVertex v = path_vertex(*bsdf_, wo_, chosen.w, uc, u, own);
    if (!v.f_cos.is_physical() || !v.weight.is_physical())
      fail({}, "the material has a defect: its f or the weight of a sample is negative, infinite or not a number");
    const TowardLight met = light.at(v.wi);
    const SampledSpectrum radiance =
        v.f_cos * (chosen.radiance / chosen.pdf * power_heuristic(chosen.pdf, v.light_pdf)) +
        v.weight * (met.radiance * power_heuristic(v.pdf, met.pdf));
    moments.add(radiance);
    return v;
  }

  Arena arena_;
  const Bsdf* bsdf_;
  Vec3 wo_;
  SunDisc sun_;
};

void check(const Worth& worth) {
  if (!std::isfinite(worth.mean.mean + worth.variance.mean))
    fail({}, "the material scattered light with a weight that is not a number");
}

}  // namespace

SampleWorth measure_worth(const PathHit& hit, int64_t samples, const ThreadPool& pool) {
  constexpr int64_t kBatches = 64;
  check_beam({hit.theta_deg, double(hit.lambda.nm[0])});
  if (hit.theta_deg == 90) fail({}, "at 90 degrees a path meets neither side of a surface");
  const int64_t of_batch = std::max<int64_t>(2, (samples + kBatches - 1) / kBatches);
  std::vector<Batch> batches(kBatches);
  pool.for_each(kBatches, [&](int64_t i, int) {
    const LitSpecimen specimen(hit);
    RandomStream rng(hash_key(hit.seed, std::bit_cast<uint64_t>(hit.theta_deg), hit.lambda.count, i));
    for (int64_t k = 0; k < of_batch; ++k) {
      check_stop();
      specimen.add_to(batches[static_cast<size_t>(i)], rng);
    }
  });
  BatchMoments albedo, sky, sun;
  for (const Batch& b : batches) {
    albedo.add(b.albedo, hit.lambda.count);
    sky.add(b.sky, hit.lambda.count);
    sun.add(b.sun, hit.lambda.count);
  }
  const SampleWorth worth{albedo.worth(), sky.worth(), sun.worth()};
  for (const Worth* w : {&worth.albedo, &worth.sky, &worth.sun}) check(*w);
  return worth;
}

}  // namespace frond
