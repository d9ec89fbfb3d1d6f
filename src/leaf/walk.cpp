#include "leaf/walk.h"

#include <cassert>

#include "leaf/fresnel.h"

namespace frond::leaf {
namespace {

/// A uniform point of the unit disk without its centre, by rejection.
struct DiskPoint {
  double x, y, r2;
};

DiskPoint sample_disk(RandomStream& rng) {
  for (;;) {
    const uint64_t bits = rng.bits();
    const double x = static_cast<double>(static_cast<int32_t>(bits >> 32)) * 0x1p-31;
    const double y = static_cast<double>(static_cast<int32_t>(bits & 0xffffffff)) * 0x1p-31;
    const double r2 = x * x + y * y;
    if (r2 < 1 && r2 > 0) return {x, y, r2};
  }
}

/// A direction of the lobe around `axis`, on the axis's side of the interface. The disk's point gives the angle to the
/// axis by its radius, of which the square is uniform, and the azimuth by its place.
Vec3d perturb(const Lobe& lobe, const Vec3d& axis, bool up, DiskPoint p, RandomStream& rng) {
  const Framed frame = Framed::around(axis);
  for (;; p = sample_disk(rng)) {
    const double cos_alpha = lobe.sample_cos(p.r2, rng);
    const double s = std::sqrt(std::max(0.0, 1 - cos_alpha * cos_alpha) / p.r2);
    const Vec3d v = frame.x * (s * p.x) + frame.y * (s * p.y) + axis * cos_alpha;
    if (up ? v.z > 0 : v.z < 0) return v * (1.5 - 0.5 * dot(v, v));  // one Newton step: lengths must not drift
  }
}

/// A ray on its way through the leaf.
class Walker {
 public:
  Walker(const Tissue& tissue, const Vec3d& wo, Absorption absorption, RandomStream& rng)
      : tissue_(tissue), rng_(rng), v_(-wo), depth_(tissue.optical_depth), absorption_(absorption), up_(wo.z < 0) {
    assert(wo.z != 0 && std::isfinite(wo.z));
    medium_ = up_ ? Tissue::kBeneath : 0;
    if (!tissue.air_space_moves) return;
    const double above = rng.uniform_double();
    depth_[2] *= above;
    depth_[4] *= 1 - above;
  }

  bool inside() const { return medium_ != 0 && medium_ != Tissue::kBeneath; }
  bool up() const { return up_; }
  const Vec3d& direction() const { return v_; }
  double weight() const { return weight_; }
  /// Crossing at the interface ahead.
  Crossing ahead() const { return fresnel(std::abs(v_.z), tissue_.n[medium_] / tissue_.n[next_medium()]); }

  /// Passes the medium to the interface ahead. False where the ray is absorbed.
  bool pass_medium() {
    const double depth = depth_[medium_];
    if (!(depth > 0)) return true;
    const double share = survival(depth, std::abs(v_.z), tissue_.sieve_and_detour);
    if (absorption_ == Absorption::analog) return rng_.uniform_double() < share;
    weight_ *= share;
    return survives_roulette();
  }

  /// Takes a branch at the interface ahead. `connect(axis, lobe)` sees the lobe before its direction is drawn.
  template <class Connect>
  void scatter(bool refracts, double cos_t, DiskPoint p, const Connect& connect) {
    const Lobe* lobe = tissue_.lobes[up_ ? medium_ - 1 : medium_][up_][refracts];
    if (refracts) {
      const size_t next = next_medium();
      const double eta = tissue_.n[medium_] / tissue_.n[next];
      v_ = {v_.x * eta, v_.y * eta, up_ ? cos_t : -cos_t};
      medium_ = next;
    } else {
      v_.z = -v_.z;
      up_ = !up_;
    }
    if (!lobe) return;
    connect(*this, *lobe);
    v_ = perturb(*lobe, v_, up_, p, rng_);
  }

  /// One event. False where the ray is absorbed.
  template <class Connect>
  bool step(const Connect& connect) {
    if (!pass_medium()) return false;
    const Crossing crossing = ahead();
    const bool refracts = rng_.uniform_double() >= crossing.reflectance;
    scatter(refracts, crossing.cos_t, sample_disk(rng_), connect);
    return true;
  }

  size_t medium() const { return medium_; }
  void scale(double factor) { weight_ *= factor; }

 private:
  size_t next_medium() const { return up_ ? medium_ - 1 : medium_ + 1; }

  bool survives_roulette() {
    constexpr double kThreshold = 0.1;
    if (weight_ >= kThreshold) return true;
    if (rng_.uniform_double() * kThreshold >= weight_) return false;
    weight_ = kThreshold;
    return true;
  }

  const Tissue& tissue_;
  RandomStream& rng_;
  Vec3d v_;
  std::array<double, Tissue::kMedia> depth_;
  double weight_ = 1;
  size_t medium_;
  Absorption absorption_;
  bool up_;
};

constexpr auto kNoConnection = [](const Walker&, const Lobe&) {};

}  // namespace

WalkEnd walk(const Tissue& tissue, const Vec3d& wo, Absorption absorption, const FirstEvent& first, RandomStream& rng) {
  Walker ray(tissue, wo, absorption, rng);
  const Crossing surface = ray.ahead();
  const bool enters = first.branch >= surface.reflectance;
  const double r2 = first.x * first.x + first.y * first.y;
  const DiskPoint p = r2 > 0 ? DiskPoint{first.x, first.y, r2} : sample_disk(rng);
  ray.scatter(enters, surface.cos_t, p, kNoConnection);
  if (!enters) return {Fate::surface, ray.direction(), 1};
  while (ray.inside())
    if (!ray.step(kNoConnection)) return {Fate::absorbed, ray.direction(), 0};
  const bool same_side = ray.up() == (wo.z > 0);
  return {same_side ? Fate::reflected : Fate::transmitted, ray.direction(), ray.weight()};
}

WalkEnd walk(const Tissue& tissue, const Vec3d& wo, Absorption absorption, RandomStream& rng) {
  const double branch = rng.uniform_double();
  const DiskPoint p = sample_disk(rng);
  return walk(tissue, wo, absorption, {branch, p.x, p.y}, rng);
}

double surface_reflectance(const Tissue& tissue, double cos_theta) {
  return fresnel(std::abs(cos_theta), 1 / tissue.n_cuticle()).reflectance;
}

double surface_f(const Tissue& tissue, const Vec3d& wo, const Vec3d& wi) {
  if (wo.z * wi.z <= 0) return 0;
  const Vec3d mirror{-wo.x, -wo.y, wo.z};
  const Lobe& lobe = tissue.surface_lobe();
  return surface_reflectance(tissue, wo.z) * lobe.density(dot(mirror, wi)) /
         (lobe.kept(std::abs(wo.z)) * std::abs(wi.z));
}

double estimate_body_f(const Tissue& tissue, const Vec3d& wo, const Vec3d& wi, Absorption absorption,
                       RandomStream& rng) {
  const bool exits_up = wi.z > 0;
  const size_t exit_medium = exits_up ? 1 : 5;
  // The direction in the epidermis that refracts into wi, by the reversal of Snell's law; Fresnel is the same both
  // ways.
  const double n = tissue.n_cuticle(), cos_out = std::abs(wi.z);
  const Crossing exit = fresnel(cos_out, 1 / n);
  const Vec3d inner{wi.x / n, wi.y / n, exits_up ? exit.cos_t : -exit.cos_t};
  // Density per solid angle outside = inside * cos_out / (n^2 cos_inner); f divides by cos_out.
  const double factor = (1 - exit.reflectance) / (n * n * exit.cos_t);

  double sum = 0;
  const auto connect = [&](const Walker& ray, const Lobe& lobe) {
    if (ray.medium() != exit_medium || ray.up() != exits_up) return;
    const Vec3d& axis = ray.direction();
    sum += ray.weight() * lobe.density(dot(axis, inner)) / lobe.kept(std::abs(axis.z));
  };
  Walker ray(tissue, wo, absorption, rng);
  const Crossing surface = ray.ahead();
  ray.scale(1 - surface.reflectance);
  ray.scatter(true, surface.cos_t, sample_disk(rng), connect);
  while (ray.inside() && ray.step(connect)) {
  }
  return sum * factor;
}

}  // namespace frond::leaf
