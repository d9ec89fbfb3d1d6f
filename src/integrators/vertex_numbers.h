#pragma once

#include <array>

#include "core/integrator.h"
#include "integrators/lane_set.h"

namespace frond {

/// Sampler dimensions of a path vertex. Those of the first vertex are the sampler's own (Dimension).
enum class Number : uint32_t { light, on_light, lobe, direction, count };
static_assert(uint32_t(Dimension::light) + uint32_t(Number::on_light) == uint32_t(Dimension::on_light));
static_assert(uint32_t(Dimension::light) + uint32_t(Number::direction) == uint32_t(Dimension::direction));

/// Most light samples and scattered rays of one vertex.
inline constexpr int kMostSplit = 2;

/// Numbers of one dimension, u[which][path]: of each of the samples that a path of a bundle takes at a vertex.
template <class T>
using SplitNumbers = std::array<std::array<T, PathBundle::kMost>, kMostSplit>;

/// Paths of a bundle by the number of samples that they take at a vertex.
class SplitLanes {
 public:
  SplitLanes() = default;
  SplitLanes(const LaneSet& lanes, int count) { of(count) = lanes; }
  void add(size_t lane, int count) { of(count).add(lane); }
  LaneSet& of(int count) { return by_count_[size_t(count) - 1]; }
  const LaneSet& of(int count) const { return by_count_[size_t(count) - 1]; }

 private:
  std::array<LaneSet, kMostSplit> by_count_;
};

inline void get_numbers(const Sampler& sampler, const PixelSamples& samples, uint32_t dimension, float* u) {
  sampler.get1d(samples, dimension, u);
}
inline void get_numbers(const Sampler& sampler, const PixelSamples& samples, uint32_t dimension, Vec2* u) {
  sampler.get2d(samples, dimension, u);
}

/// Draws the sampler's numbers of one vertex, by its index. A path that takes n gets those of samples n i to
/// n i + n - 1, so that the numbers of all paths together are as well distributed as those of n times as many samples.
/// `separate`: the same numbers in another order, so that the first ones of all paths of the bundle are well
/// distributed too, and the second ones, and so on.
template <class T>
void draw_numbers(const PathBundle& bundle, uint64_t vertex, Number number, const SplitLanes& lanes, bool separate,
                  SplitNumbers<T>& u) {
  constexpr size_t kFew = 4;  // for more paths, the numbers of the whole bundle are as fast
  const uint32_t dimension = bundle.dimension + uint32_t(vertex) * uint32_t(Number::count) + uint32_t(number);
  const PixelSamples& s = bundle.samples;
  std::array<T, size_t(kMostSplit) * PathBundle::kMost> all;
  for (uint32_t n = 1; n <= kMostSplit; ++n) {
    const LaneSet& paths = lanes.of(int(n));
    if (paths.empty()) continue;
    T* const drawn = n == 1 ? u[0].data() : all.data();
    if (paths.size() > kFew || separate) {
      get_numbers(bundle.sampler, {s.x, s.y, n * s.first, n * s.count}, dimension, drawn);
    } else {
      for (const size_t i : paths)
        get_numbers(bundle.sampler, {s.x, s.y, n * (s.first + i), n}, dimension, &drawn[n * i]);
    }
    if (n == 1) continue;
    for (const size_t i : paths)
      for (size_t k = 0; k < n; ++k) u[k][i] = all[separate ? k * s.count + i : n * i + k];
  }
}

}  // namespace frond
