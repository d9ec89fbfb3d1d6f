#pragma once

#include <cassert>
#include <cmath>

#include "core/math/random.h"
#include "core/math/vec.h"
#include "leaf/tissue/fresnel.h"
#include "leaf/tissue/tissue.h"
#include "leaf/walk/walk.h"

namespace frond::leaf {

/// Point of the unit disk, not its centre; r2 is the square of the radius.
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

/// Draws a direction of the lobe around `axis`, on the axis's side of the interface. The disk's point gives the angle
/// to the axis by its radius, whose square is uniform, and the azimuth by its direction.
inline Vec3d perturb(const Lobe& lobe, const Vec3d& axis, bool up, DiskPoint p, RandomStream& rng) {
  const Framed frame = Framed::around(axis);
  for (;; p = sample_disk(rng)) {
    const double cos_alpha = lobe.sample_cos(p.r2, rng);
    const double s = std::sqrt(std::max(0.0, 1 - cos_alpha * cos_alpha) / p.r2);
    const Vec3d v = frame.x * (s * p.x) + frame.y * (s * p.y) + axis * cos_alpha;
    if (up ? v.z > 0 : v.z < 0) return v * (1.5 - 0.5 * dot(v, v));  // one Newton step: lengths must not drift
  }
}

/// The direction in the epidermis that refracts into `wi`, and its Fresnel reflectance, by Snell's law reversed.
struct InnerDirection {
  Vec3d w;
  double reflectance, cos_theta;  ///< cos_theta 0: there is no such direction

  InnerDirection(const Vec3d& wi, double n_cuticle) {
    const Crossing exit = fresnel(std::abs(wi.z), 1 / n_cuticle);
    w = {wi.x / n_cuticle, wi.y / n_cuticle, std::copysign(exit.cos_t, wi.z)};
    reflectance = exit.reflectance;
    cos_theta = exit.cos_t;
  }
  /// Returns (1 - F) / (n^2 cos theta), which converts a density per solid angle inside to f. The density outside is
  /// cos theta_i times as large, and f divides by that cosine again.
  double factor(double n_cuticle) const {
    return cos_theta > 0 ? (1 - reflectance) / (n_cuticle * n_cuticle * cos_theta) : 0;
  }
};

/// For walks that connect their lobes with nothing outside.
inline constexpr auto kNoConnection = [](const Lobe&) {};

/// State of a walk through the leaf, at K wavelengths at once.
///
/// The hero's random numbers draw the path: the branch at each interface, the directions from lobes, and the direction
/// outside. Each wavelength has a density with which it would have drawn the same path; its weight is that density over
/// the mean of all K (the balance heuristic of Veach and Guibas 1995; hero wavelengths after Wilkie et al. 2014). Where
/// an interface does not perturb, each wavelength follows the direction that its own index refracts into.
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

  /// Starts inside a medium that absorbs. `above`: share of the mesophyll above the air space, where that moves.
  Walker(const Tissues& tissues, size_t hero, const Vec3d& direction, size_t medium, double above,
         Absorption absorption, RandomStream& rng)
      : tissues_(tissues),
        rng_(rng),
        above_(above),
        hero_(hero),
        medium_(medium),
        absorption_(absorption),
        up_(direction.z > 0) {
    v_.fill(direction);
    density_.fill(1);
    share_.fill(1);
  }

  bool inside() const { return medium_ != 0 && medium_ != Tissue::kBeneath; }
  bool up() const { return up_; }
  size_t medium() const { return medium_; }
  /// Share of the mesophyll above the air space, where that moves.
  double above() const { return above_; }
  /// Whether the ray can never leave: see `step`.
  bool is_trapped() const { return total_mirrors_ >= 2; }
  /// Attenuation of the hero on its way through the whole medium: -ln of the share that is transmitted.
  double attenuation() const { return path_depth(depth(hero_), std::abs(direction().z), tissue().sieve_and_detour); }
  /// Direction of the hero.
  const Vec3d& direction() const { return v_[hero_]; }
  /// Ideal direction at one wavelength, before a lobe perturbs it.
  const Vec3d& axis(size_t lane) const { return v_[lane]; }

  /// Weights: remaining shares of the ray, times each wavelength's density over the mean of all densities.
  Values weights() const {
    if constexpr (K == 1) return share_;
    double sum = 0;
    for (const double d : density_) sum += d;
    Values w;
    for (size_t i = 0; i < K; ++i) w[i] = share_[i] * density_[i] * (double(K) / sum);
    return w;
  }

  /// Reflectance and refraction at the next interface.
  Crossings next_crossings() const {
    Crossings c;
    for (size_t i = 0; i < K; ++i) c[i] = fresnel(std::abs(v_[i].z), eta(i));
    return c;
  }

  /// Reflects or refracts and then perturbs. Calls `connect(lobe)` before the direction is drawn.
  template <class Connect>
  void scatter(bool refracts, const Crossings& crossings, DiskPoint p, const Connect& connect) {
    for (size_t i = 0; i < K && K > 1; ++i)
      density_[i] *= probability(refracts, crossings[i]) / hero_probability(refracts, crossings);
    turn(refracts, crossings, p, connect);
  }

  /// Refracts into the leaf; the probability of that becomes part of the weight. Returns false if the hero is totally
  /// reflected.
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

  /// Executes one event. Returns false if the ray is absorbed or can never leave: between two interfaces that reflect
  /// it totally without perturbing it, it continues until it is absorbed, without end in a clear medium. `way`: share
  /// of the medium that lies ahead.
  template <class Connect>
  bool step(const Connect& connect, double way = 1) {
    if (!pass_medium(way)) return false;
    const Crossings crossings = next_crossings();
    const bool refracts = rng_.uniform_double() >= crossings[hero_].reflectance;
    scatter(refracts, crossings, sample_disk(rng_), connect);
    return !is_trapped();
  }

  /// Call when the ray has left the leaf: replaces the density of the last direction drawn inside by the density of the
  /// direction outside, which all wavelengths share.
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

  /// Density, 1/sr, of directions drawn around `axis` and cut at the interface.
  static double lobe_density(const Lobe& lobe, const Vec3d& axis, const Vec3d& w) {
    return lobe.density(dot(axis, w)) / lobe.kept_share(std::abs(axis.z));
  }

 private:
  /// State before the last direction was drawn.
  struct Draw {
    const Lobe* lobe;
    std::array<Vec3d, K> axis;
    Values density;
  };

  const Tissue& tissue() const { return *tissues_[hero_]; }
  size_t next_medium() const { return up_ ? medium_ - 1 : medium_ + 1; }
  double eta(size_t lane) const { return tissues_[lane]->n[medium_] / tissues_[lane]->n[next_medium()]; }
  static double probability(bool refracts, const Crossing& c) { return refracts ? 1 - c.reflectance : c.reflectance; }
  double hero_probability(bool refracts, const Crossings& c) const { return probability(refracts, c[hero_]); }

  /// Optical depth of the current medium. Where the air space moves, media 2 and 4 share the mesophyll.
  double depth(size_t lane) const {
    const double whole = tissues_[lane]->optical_depth[medium_];
    if (!tissue().air_space_moves) return whole;
    return medium_ == 2 ? whole * above_ : whole * (1 - above_);
  }

  /// Passes the medium, or the share `way` of it, up to the next interface. Returns false if the ray is absorbed.
  bool pass_medium(double way) {
    Values survives;
    bool clear = true;
    for (size_t i = 0; i < K; ++i) {
      survives[i] = survival(depth(i) * way, std::abs(v_[i].z), tissue().sieve_and_detour);
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

  /// Russian roulette. Its probability is a function of the path alone, not of the hero, so it cancels in the balance
  /// heuristic.
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
      if (axes_differ()) update_lane_densities(lobe, drawn);
    }
    v_.fill(drawn);
  }

  /// Rare inside one medium: all wavelengths share a direction that was drawn.
  bool axes_differ() const {
    for (size_t i = 0; i < K; ++i)
      if (v_[i] != direction()) return true;
    return false;
  }

  void update_lane_densities(const Lobe& lobe, const Vec3d& drawn) {
    const double hero_density = lobe_density(lobe, direction(), drawn);
    for (size_t i = 0; i < K; ++i)
      if (i != hero_ && hero_density > 0 && density_[i] > 0 && v_[i] != direction())
        density_[i] *= lobe_density(lobe, v_[i], drawn) / hero_density;
  }

  Tissues tissues_;
  RandomStream& rng_;
  std::array<Vec3d, K> v_;
  Values density_;  ///< of the path, relative to the hero's
  Values share_;    ///< remaining share of the ray: absorption, and probabilities that were not drawn
  Draw last_;
  double above_ = 0;  ///< share of the mesophyll above the air space, where that moves
  size_t hero_, medium_;
  int total_mirrors_ = 0;  ///< total reflections in a row that kept the angle
  Absorption absorption_;
  bool up_;
};

}  // namespace frond::leaf
