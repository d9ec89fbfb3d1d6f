#pragma once

#include <array>
#include <bit>

#include "core/integrator.h"

namespace frond {

/// Set of paths of a bundle, by index.
class LaneSet {
 public:
  explicit LaneSet(uint32_t bits = 0) : bits_(bits) {}
  void add(size_t lane) { bits_ |= 1u << lane; }
  bool empty() const { return bits_ == 0; }
  size_t size() const { return size_t(std::popcount(bits_)); }
  uint32_t bits() const { return bits_; }

  /// Ascending.
  class Iterator {
   public:
    explicit Iterator(uint32_t left) : left_(left) {}
    size_t operator*() const { return size_t(std::countr_zero(left_)); }
    void operator++() { left_ &= left_ - 1; }
    bool operator!=(Iterator other) const { return left_ != other.left_; }

   private:
    uint32_t left_;
  };
  Iterator begin() const { return Iterator(bits_); }
  Iterator end() const { return Iterator(0); }

 private:
  uint32_t bits_;
};

/// Sampler dimensions of a path vertex. Those of the first vertex are the sampler's own (Dimension).
enum class Number : uint32_t {
  light,
  on_light,
  lobe,
  direction,
  count,
  distance = count,  ///< in a medium
};
static_assert(uint32_t(Dimension::light) + uint32_t(Number::on_light) == uint32_t(Dimension::on_light));
static_assert(uint32_t(Dimension::light) + uint32_t(Number::direction) == uint32_t(Dimension::direction));

/// Sampler dimension of a number of a vertex, by the vertex's index. `numbers`: how many of them a vertex has.
inline uint32_t dimension_of(const PathBundle& bundle, uint64_t vertex, Number number,
                             uint32_t numbers = uint32_t(Number::count)) {
  return bundle.dimension + uint32_t(vertex) * numbers + uint32_t(number);
}

/// Most light samples and scattered rays of one vertex.
inline constexpr int kMostSplit = 2;

/// Numbers of one dimension, u[which][path]: of each of the samples that a path of a bundle takes at a vertex.
template <class T>
using SplitNumbers = std::array<std::array<T, PathBundle::kSize>, kMostSplit>;

/// Paths of a bundle by the number of samples that they take at a vertex.
class SplitLanes {
 public:
  SplitLanes() = default;
  SplitLanes(const LaneSet& lanes, int count) { by_count_[size_t(count) - 1] = lanes; }
  void add(size_t lane, int count) { by_count_[size_t(count) - 1].add(lane); }
  const LaneSet& with_count(uint32_t count) const { return by_count_[count - 1]; }

 private:
  std::array<LaneSet, kMostSplit> by_count_;
};

inline void get_numbers(const Sampler& sampler, const PixelSamples& samples, uint32_t dimension, float* u) {
  sampler.get1d(samples, dimension, u);
}
inline void get_numbers(const Sampler& sampler, const PixelSamples& samples, uint32_t dimension, Vec2* u) {
  sampler.get2d(samples, dimension, u);
}

/// Draws the sampler's numbers of one vertex, by its index. Path i, if it takes n numbers, gets those of the sampler's
/// samples n i to n i + n - 1, so that the numbers of all paths together are as well distributed as those of n times as
/// many samples. `separate`: the same numbers in another order, in which the first numbers of all paths of the bundle
/// are well distributed too, and so are the second ones.
template <class T>
void draw_numbers(const PathBundle& bundle, uint64_t vertex, Number number, const SplitLanes& lanes, bool separate,
                  SplitNumbers<T>& u) {
  constexpr size_t kFew = 4;  // for more paths, the numbers of the whole bundle are as fast
  const uint32_t dimension = dimension_of(bundle, vertex, number);
  const PixelSamples& s = bundle.samples;
  std::array<T, size_t(kMostSplit) * PathBundle::kSize> all;
  for (uint32_t n = 1; n <= kMostSplit; ++n) {
    const LaneSet& paths = lanes.with_count(n);
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

/// Draws the number, or the pair of numbers, of one vertex of one path of a bundle, whose vertices have all Numbers.
template <class T>
T draw_number(const PathBundle& bundle, size_t lane, int vertex, Number number) {
  constexpr uint32_t kNumbers = uint32_t(Number::distance) + 1;
  const PixelSamples& s = bundle.samples;
  T u;
  get_numbers(bundle.sampler, {s.x, s.y, s.first + lane, 1}, dimension_of(bundle, uint64_t(vertex), number, kNumbers),
              &u);
  return u;
}

}  // namespace frond
