#pragma once

#include <cassert>
#include <cmath>

#include "core/random.h"
#include "core/vec.h"
#include "leaf/tissue/fresnel.h"
#include "leaf/tissue/tissue.h"
#include "leaf/walk/walk.h"

namespace frond::leaf {

/// A uniform point of the unit disk without its centre.
struct DiskPoint {
  double x, y, r2;
};

inline DiskPoint sample_disk(RandomStream& rng) {
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
inline Vec3d perturb(const Lobe& lobe, const Vec3d& axis, bool up, DiskPoint p, RandomStream& rng) {
  const Framed frame = Framed::around(axis);
  for (;; p = sample_disk(rng)) {
    const double cos_alpha = lobe.sample_cos(p.r2, rng);
    const double s = std::sqrt(std::max(0.0, 1 - cos_alpha * cos_alpha) / p.r2);
    const Vec3d v = frame.x * (s * p.x) + frame.y * (s * p.y) + axis * cos_alpha;
    if (up ? v.z > 0 : v.z < 0) return v * (1.5 - 0.5 * dot(v, v));  // one Newton step: lengths must not drift
  }
}

/// The direction in the epidermis that refracts into `wi`, and its Fresnel reflectance, by the reversal of Snell's law.
struct InnerDirection {
  Vec3d w;
  double reflectance, cos_theta;  ///< cos_theta 0: there is none

  InnerDirection(const Vec3d& wi, double n_cuticle) {
    const Crossing exit = fresnel(std::abs(wi.z), 1 / n_cuticle);
    w = {wi.x / n_cuticle, wi.y / n_cuticle, std::copysign(exit.cos_t, wi.z)};
    reflectance = exit.reflectance;
    cos_theta = exit.cos_t;
  }
  /// (1 - F) / (n^2 cos theta): makes f of a density per solid angle inside. Outside a density is cos theta_i times as
  /// large, which f divides by again.
  double factor(double n_cuticle) const {
    return cos_theta > 0 ? (1 - reflectance) / (n_cuticle * n_cuticle * cos_theta) : 0;
  }
};

/// A ray on its way through the leaf, at K wavelengths at once.
///
/// The hero's random numbers draw the path: which branch it takes at each interface, the directions that are drawn from
/// lobes, and the one that it leaves by. Each wavelength has a density with which it would have drawn the same path,
/// and its weight is that over the mean of them all (the balance heuristic of Veach and Guibas 1995; hero wavelengths
/// after Wilkie et al. 2014). Where an interface does not perturb, the path has no direction of its own, and every
/// wavelength has the one that its own index refracts into.
template <size_t K>
class Walker {
 public:
  using Tissues = std::array<const Tissue*, K>;  ///< of one leaf: they differ in indices and depths alone
  using Values = std::array<double, K>;
  using Crossings = std::array<Crossing, K>;

  Walker(const Tissues& tissues, size_t hero, const Vec3d& wo, Absorption absorption, RandomStream& rng)
      : tissues_(tissues), rng_(rng), hero_(hero), absorption_(absorption), up_(wo.z < 0) {
    assert(wo.z != 0 && std::isfinite(wo.z));
    v_.fill(-wo);
    density_.fill(1);
    share_.fill(1);
    medium_ = up_ ? Tissue::kBeneath : 0;
    if (tissue().air_space_moves) above_ = rng.uniform_double();
  }

  bool inside() const { return medium_ != 0 && medium_ != Tissue::kBeneath; }
  bool up() const { return up_; }
  size_t medium() const { return medium_; }
  /// The hero's.
  const Vec3d& direction() const { return v_[hero_]; }
  /// The ideal one, before a lobe spreads it, at one wavelength.
  const Vec3d& axis(size_t lane) const { return v_[lane]; }

  /// Shares of the ray that are left, over the densities with which any hero would have drawn it.
  Values weights() const {
    if constexpr (K == 1) return share_;
    double sum = 0;
    for (const double d : density_) sum += d;
    Values w;
    for (size_t i = 0; i < K; ++i) w[i] = share_[i] * density_[i] * (double(K) / sum);
    return w;
  }

  /// At the interface ahead.
  Crossings ahead() const {
    Crossings c;
    for (size_t i = 0; i < K; ++i) c[i] = fresnel(std::abs(v_[i].z), eta(i));
    return c;
  }

  /// Reflects or refracts and then perturbs. `connect(lobe)` sees the ray before its direction is drawn.
  template <class Connect>
  void scatter(bool refracts, const Crossings& crossings, DiskPoint p, const Connect& connect) {
    for (size_t i = 0; i < K && K > 1; ++i)
      density_[i] *= chance(refracts, crossings[i]) / hero_chance(refracts, crossings);
    turn(refracts, crossings, p, connect);
  }

  /// Refracts into the leaf whatever the chance of it, which becomes part of the weight. False where the hero cannot.
  template <class Connect>
  bool enter(const Crossings& crossings, DiskPoint p, const Connect& connect) {
    for (size_t i = 0; i < K; ++i) {
      share_[i] *= 1 - crossings[i].reflectance;
      if (crossings[i].cos_t == 0) density_[i] = 0;
    }
    if (density_[hero_] == 0) return false;
    turn(true, crossings, p, connect);
    return true;
  }

  /// One event. False where the ray is absorbed, or never leaves: between two interfaces that mirror it and let nothing
  /// through it goes to and fro until it is absorbed, in a clear medium without end.
  template <class Connect>
  bool step(const Connect& connect) {
    if (!pass_medium()) return false;
    const Crossings crossings = ahead();
    const bool refracts = rng_.uniform_double() >= crossings[hero_].reflectance;
    scatter(refracts, crossings, sample_disk(rng_), connect);
    return total_mirrors_ < 2;
  }

  /// Once the ray is out: what belongs to the path is the direction outside, in place of the last one drawn inside.
  void leave() {
    if constexpr (K > 1) {
      const Vec3d wi = direction();
      Values exit;
      for (size_t i = 0; i < K; ++i) {
        const double n = tissues_[i]->n_cuticle();
        const InnerDirection inner(wi, n);
        exit[i] = lobe_density(*last_.lobe, last_.axis[i], inner.w) * inner.factor(n);
      }
      for (size_t i = 0; i < K; ++i) density_[i] = exit[hero_] > 0 ? last_.density[i] * exit[i] / exit[hero_] : 0;
      if (!(exit[hero_] > 0)) density_[hero_] = 1;  // the very edge of the lobe, drawn by rounding
    }
  }

  /// Of directions drawn around `axis`, cut off at the interface.
  static double lobe_density(const Lobe& lobe, const Vec3d& axis, const Vec3d& w) {
    return lobe.density(dot(axis, w)) / lobe.kept(std::abs(axis.z));
  }

 private:
  /// The path before its last direction was drawn.
  struct Draw {
    const Lobe* lobe;
    std::array<Vec3d, K> axis;
    Values density;
  };

  const Tissue& tissue() const { return *tissues_[hero_]; }
  size_t next_medium() const { return up_ ? medium_ - 1 : medium_ + 1; }
  double eta(size_t lane) const { return tissues_[lane]->n[medium_] / tissues_[lane]->n[next_medium()]; }
  static double chance(bool refracts, const Crossing& c) { return refracts ? 1 - c.reflectance : c.reflectance; }
  double hero_chance(bool refracts, const Crossings& c) const { return chance(refracts, c[hero_]); }

  /// Where the air space moves, media 2 and 4 share the mesophyll.
  double depth(size_t lane) const {
    const double whole = tissues_[lane]->optical_depth[medium_];
    if (!tissue().air_space_moves) return whole;
    return medium_ == 2 ? whole * above_ : whole * (1 - above_);
  }

  /// To the interface ahead. False where the ray is absorbed.
  bool pass_medium() {
    Values survives;
    bool clear = true;
    for (size_t i = 0; i < K; ++i) {
      survives[i] = survival(depth(i), std::abs(v_[i].z), tissue().sieve_and_detour);
      clear = clear && survives[i] == 1;
    }
    if (clear) return true;
    if (absorption_ == Absorption::analog) {
      if (rng_.uniform_double() >= survives[hero_]) return false;
      for (size_t i = 0; i < K && K > 1; ++i) density_[i] *= survives[i] / survives[hero_];
      return true;
    }
    for (size_t i = 0; i < K; ++i) share_[i] *= survives[i];
    return survives_roulette();
  }

  /// Its chance is a function of the path alone, not of the hero.
  bool survives_roulette() {
    constexpr double kThreshold = 0.1;
    double weight = 0;
    for (const double w : weights()) weight = std::max(weight, w);
    if (weight >= kThreshold) return true;
    if (rng_.uniform_double() * kThreshold >= weight) return false;
    for (double& share : share_) share *= kThreshold / weight;
    return true;
  }

  template <class Connect>
  void turn(bool refracts, const Crossings& crossings, DiskPoint p, const Connect& connect) {
    const Lobe* lobe = tissue().lobe(up_ ? medium_ - 1 : medium_, up_, refracts);
    if (refracts) {
      for (size_t i = 0; i < K; ++i) {
        const double ratio = eta(i), z = crossings[i].cos_t;
        v_[i] = {v_[i].x * ratio, v_[i].y * ratio, up_ ? z : -z};
      }
      medium_ = next_medium();
    } else {
      for (Vec3d& v : v_) v.z = -v.z;
      up_ = !up_;
    }
    total_mirrors_ = !lobe && !refracts && crossings[hero_].cos_t == 0 ? total_mirrors_ + 1 : 0;
    if (!lobe) return;
    connect(*lobe);
    spread(*lobe, p);
  }

  void spread(const Lobe& lobe, DiskPoint p) {
    const Vec3d drawn = perturb(lobe, direction(), up_, p, rng_);
    if constexpr (K > 1) {
      last_ = {&lobe, v_, density_};
      if (axes_differ()) weigh_axes(lobe, drawn);
    }
    v_.fill(drawn);
  }

  /// Rarely inside one medium: a direction that was drawn is every wavelength's.
  bool axes_differ() const {
    for (size_t i = 0; i < K; ++i)
      if (v_[i] != direction()) return true;
    return false;
  }

  void weigh_axes(const Lobe& lobe, const Vec3d& drawn) {
    const double hero_density = lobe_density(lobe, direction(), drawn);
    for (size_t i = 0; i < K; ++i)
      if (i != hero_ && hero_density > 0 && density_[i] > 0 && v_[i] != direction())
        density_[i] *= lobe_density(lobe, v_[i], drawn) / hero_density;
  }

  Tissues tissues_;
  RandomStream& rng_;
  std::array<Vec3d, K> v_;
  Values density_;  ///< of the path, relative to the hero's
  Values share_;    ///< what is left of the ray: absorption, and chances that were not drawn
  Draw last_;
  double above_ = 0;  ///< share of the mesophyll that lies above the air space, where that moves
  size_t hero_, medium_;
  int total_mirrors_ = 0;  ///< total reflections in a row that kept the angle
  Absorption absorption_;
  bool up_;
};

}  // namespace frond::leaf
