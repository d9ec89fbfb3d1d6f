#pragma once

#include <array>

#include "core/integrator.h"
#include "integrators/lane_set.h"

namespace frond {

/// Sampler dimensions of a path vertex. Those of the first vertex are the sampler's own (Dimension).
enum class Number : uint32_t { light, on_light, lobe, direction, count };
static_assert(uint32_t(Dimension::light) + uint32_t(Number::on_light) == uint32_t(Dimension::on_light));
static_assert(uint32_t(Dimension::light) + uint32_t(Number::direction) == uint32_t(Dimension::direction));

/// Numbers of one dimension by path of a bundle: of a first sample and of a second one.
template <class T>
using TwinNumbers = std::array<std::array<T, PathBundle::kMost>, 2>;

inline void get_numbers(const Sampler& sampler, const PixelSamples& samples, uint32_t dimension, float* u) {
  sampler.get1d(samples, dimension, u);
}
inline void get_numbers(const Sampler& sampler, const PixelSamples& samples, uint32_t dimension, Vec2* u) {
  sampler.get2d(samples, dimension, u);
}

/// Draws the sampler's numbers of one vertex, by its index, for these paths. The `twins` among them get two: those of
/// samples 2 i and 2 i + 1, so that all first and second ones together are as well distributed as those of twice as
/// many samples.
template <class T>
void draw_numbers(const PathBundle& bundle, uint64_t vertex, Number number, const LaneSet& lanes, const LaneSet& twins,
                  TwinNumbers<T>& u) {
  constexpr size_t kFew = 4;  // for more paths, the numbers of the whole bundle are as fast
  const uint32_t dimension = bundle.dimension + uint32_t(vertex) * uint32_t(Number::count) + uint32_t(number);
  const PixelSamples& s = bundle.samples;
  const LaneSet others(lanes.bits() & ~twins.bits());
  if (others.size() > kFew) {
    get_numbers(bundle.sampler, s, dimension, u[0].data());
  } else {
    for (const size_t i : others) get_numbers(bundle.sampler, {s.x, s.y, s.first + i, 1}, dimension, &u[0][i]);
  }
  if (twins.empty()) return;
  std::array<T, 2 * PathBundle::kMost> both;
  if (twins.size() > kFew) {
    get_numbers(bundle.sampler, {s.x, s.y, 2 * s.first, 2 * s.count}, dimension, both.data());
  } else {
    for (const size_t i : twins) get_numbers(bundle.sampler, {s.x, s.y, 2 * (s.first + i), 2}, dimension, &both[2 * i]);
  }
  for (const size_t i : twins) u[0][i] = both[2 * i], u[1][i] = both[2 * i + 1];
}

}  // namespace frond
