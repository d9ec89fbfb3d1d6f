#pragma once

#include "leaf/walk/batch_lanes.h"
#include "leaf/walk/batch_slots.h"

/// One event of the walk for a SIMD register of rays; walk.cpp has it for one ray: absorption in the medium, Fresnel
/// and Snell, a draw from the lobe. Every lane executes all of it, and masks select the results.
namespace frond::leaf::batch {
namespace {

/// Lower bound of cosines to an interface that are divided by.
constexpr float kLeastCosine = 1e-12f;

/// As many of the Slots as a register has lanes.
struct Rays {
  Floats cos_theta, sin_theta, cos_phi, sin_phi;
  Ints up, state, draws_again;
  Floats narrowness, air_space, weight;
  Generators random;

  Rays(const Slots& s, size_t i)
      : cos_theta(load<Floats>(s.cos_theta + i)),
        sin_theta(load<Floats>(s.sin_theta + i)),
        cos_phi(load<Floats>(s.cos_phi + i)),
        sin_phi(load<Floats>(s.sin_phi + i)),
        up(load<Ints>(s.up + i)),
        state(load<Ints>(s.state + i)),
        draws_again(load<Ints>(s.draws_again + i)),
        narrowness(load<Floats>(s.narrowness + i)),
        air_space(load<Floats>(s.air_space + i)),
        weight(load<Floats>(s.weight + i)),
        random{load<Bits>(s.a + i), load<Bits>(s.b + i), load<Bits>(s.c + i), load<Bits>(s.counter + i)} {}

  void save(Slots& s, size_t i) const {
    store(s.cos_theta + i, cos_theta), store(s.sin_theta + i, sin_theta);
    store(s.cos_phi + i, cos_phi), store(s.sin_phi + i, sin_phi);
    store(s.up + i, up), store(s.state + i, state), store(s.draws_again + i, draws_again);
    store(s.narrowness + i, narrowness), store(s.weight + i, weight);
    store(s.a + i, random.a), store(s.b + i, random.b), store(s.c + i, random.c), store(s.counter + i, random.counter);
  }
};

/// Returns the weights after Russian roulette of those below 0.1.
inline Floats russian_roulette(Floats weight, Floats uniform) {
  constexpr float kThreshold = 0.1f;
  const Floats lifted = uniform * kThreshold < weight ? broadcast(kThreshold) : broadcast(0);
  return weight >= kThreshold ? weight : lifted;
}

/// Passes the medium up to the interface. Returns -log2 of uniform numbers for the lobe: the excess of an exponential
/// variable over the depth is an exponential variable again, so what remains of the draw for absorption is reused.
template <bool kWeighted, bool kSieve>
Floats pass_medium(const Tables& tables, Rays& rays) {
  const Floats depth = gather(tables.depth, rays.state) + gather(tables.depth_slope, rays.state) * rays.air_space;
  const Floats way = rays.draws_again ? broadcast(0) : depth / (kSieve ? cos_of(rays.cos_theta) : rays.cos_theta);
  const Floats exponential = rays.random.exponential();
  if constexpr (kWeighted) {
    rays.weight = russian_roulette(rays.weight * exp2_of(-way), rays.random.uniform());
    return exponential;
  } else {
    rays.weight = exponential < way ? broadcast(0) : rays.weight;
    return larger(exponential - way, broadcast(0));
  }
}

/// Fresnel reflectance of unpolarised light below the critical angle.
inline Floats reflectance(Floats cos_i, Floats cos_t, Floats eta) {
  const Floats s = eta * cos_i - cos_t, s_sum = eta * cos_i + cos_t;
  const Floats p = cos_i - eta * cos_t, p_sum = cos_i + eta * cos_t;
  const Floats scale = 1.f / (s_sum * p_sum), rs = s * p_sum * scale, rp = p * s_sum * scale;
  return 0.5f * (rs * rs + rp * rp);
}

/// Reflects or refracts the rays that do not draw again, and finds their lobes.
inline void cross_interface(const Tables& tables, Rays& rays) {
  const Floats eta = gather(tables.eta, rays.state), sin_t = eta * rays.sin_theta, eta_cos = eta * rays.cos_theta;
  // In this form cos_t keeps its precision where light is grazing on either side.
  const Floats cos2_t = eta_cos * eta_cos + gather(tables.one_less_eta2, rays.state);
  const Ints total = cos2_t <= 0.f;
  const Floats cos_t = square_root(total ? broadcast(1) : cos2_t);
  const Ints reflects = total | (rays.random.uniform() < reflectance(rays.cos_theta, cos_t, eta));
  const Ints refracts = ~(reflects | rays.draws_again);
  rays.up ^= reflects & ~rays.draws_again;
  rays.cos_theta = refracts ? cos_t : rays.cos_theta;
  rays.sin_theta = refracts ? sin_t : rays.sin_theta;
  const Floats after_reflection = gather(tables.narrowness_reflected, rays.state);
  const Floats after_refraction = gather(tables.narrowness_refracted, rays.state);
  rays.narrowness = rays.draws_again ? rays.narrowness : reflects ? after_reflection : after_refraction;
}

/// Turns rays into directions drawn from their lobes if those stay on the same side of the interface; the other rays
/// will draw again. Narrowness 0, no lobe, draws the axis itself.
inline void perturb(Rays& rays, Floats exponential) {
  const Floats cos_a = exp2_of(-exponential * rays.narrowness);
  const Floats sin_a = square_root(larger(1.f - cos_a * cos_a, broadcast(0)));
  const auto [cos_b, sin_b] = circle_point(rays.random.bits());
  // In the frame of the axis, the meridian and the parallel through it; the axis is taken to go up.
  const Floats across = sin_a * cos_b, sideways = sin_a * sin_b;
  const Floats z = rays.cos_theta * cos_a + rays.sin_theta * across;
  const Floats ahead = rays.sin_theta * cos_a - rays.cos_theta * across;
  const Floats sine = square_root(ahead * ahead + sideways * sideways);

  const Ints kept = z > 0.f, turns = kept & (sine > kLeastCosine);
  const Floats scale = 1.f / larger(sine, broadcast(kLeastCosine)), turn_cos = ahead * scale,
               turn_sin = sideways * scale;
  const Floats cos_phi = rays.cos_phi, sin_phi = rays.sin_phi;
  rays.cos_phi = turns ? cos_phi * turn_cos - sin_phi * turn_sin : cos_phi;
  rays.sin_phi = turns ? sin_phi * turn_cos + cos_phi * turn_sin : sin_phi;
  const Floats unit = 1.5f - 0.5f * (z * z + sine * sine);  // one Newton step: lengths must not drift
  rays.cos_theta = kept ? z * unit : rays.cos_theta;
  rays.sin_theta = kept ? sine * unit : rays.sin_theta;
  rays.draws_again = ~kept;
}

/// Advances to the next interface. Returns the mask of the rays whose walk has ended, which keep their state.
inline Ints advance(Rays& rays) {
  const Ints next = rays.up ? (rays.state | 1) - 2 : (rays.state & ~1) + 2;
  const Ints outside = (next < 0) | (next >= static_cast<int32_t>(kStates));
  const Ints ended = (rays.weight == 0.f) | (outside & ~rays.draws_again);
  rays.state = ended | rays.draws_again ? rays.state : next;
  return ended;
}

template <bool kWeighted, bool kSieve>
Ints event(const Tables& tables, Slots& slots, size_t i) {
  Rays rays(slots, i);
  rays.cos_theta = larger(rays.cos_theta, broadcast(kLeastCosine));
  const Floats exponential = pass_medium<kWeighted, kSieve>(tables, rays);
  cross_interface(tables, rays);
  perturb(rays, exponential);
  const Ints ended = advance(rays);
  rays.save(slots, i);
  return ended;
}

/// Flattened, so that registers are not spilled between functions.
template <bool kWeighted, bool kSieve>
[[gnu::flatten]] uint64_t step(const Tables& tables, Slots& slots, size_t count) {
  static_assert(Slots::kCount % kLanes == 0 && Slots::kCount <= 64);
  uint64_t ended = 0;
  for (size_t i = 0; i < count; i += kLanes) ended |= to_bitmask(event<kWeighted, kSieve>(tables, slots, i)) << i;
  return ended;
}

constexpr Kernel kernel(const char* name) {
  return {name, {{step<false, false>, step<false, true>}, {step<true, false>, step<true, true>}}};
}

}  // namespace
}  // namespace frond::leaf::batch
