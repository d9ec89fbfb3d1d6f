#pragma once

#include <cstdint>
#include <string_view>

namespace frond {

/// Bijective 64-bit hash (Stafford's variant 13, the finalizer of SplitMix64; Steele et al. 2014).
constexpr uint64_t mix64(uint64_t v) {
  v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9ull;
  v = (v ^ (v >> 27)) * 0x94d049bb133111ebull;
  return v ^ (v >> 31);
}

/// Hash of its arguments in their order: a key of a random stream, or a content hash of a small record.
template <class... Parts>
constexpr uint64_t hash_key(uint64_t first, Parts... rest) {
  uint64_t h = mix64(first + 0x9e3779b97f4a7c15ull);
  ((h = mix64(h + 0x9e3779b97f4a7c15ull + static_cast<uint64_t>(rest))), ...);
  return h;
}

/// FNV-1a hash of `bytes`, then mix64: the content hash of files and of parameter text.
constexpr uint64_t hash_bytes(std::string_view bytes, uint64_t seed = 0) {
  uint64_t h = 0xcbf29ce484222325ull ^ seed;  // FNV's offset basis
  for (const char c : bytes) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return mix64(h);
}

/// Counter-based random number generator (SplitMix64): number n of a stream depends only on its key and n, so that
/// results do not depend on threads, tiles or the order in which pixels are rendered. One stream is for one thread.
class RandomStream {
 public:
  explicit constexpr RandomStream(uint64_t key) : state_(key) {}

  /// 64 random bits.
  constexpr uint64_t bits() { return mix64(state_ += 0x9e3779b97f4a7c15ull); }
  /// Uniform in [0, 1), 24 bits.
  constexpr float uniform() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }
  /// Uniform in [0, 1), 53 bits.
  constexpr double uniform_double() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  /// Uniform in (0, 1), 52 bits; never 0, so that its logarithm is finite.
  constexpr double uniform_open() { return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52; }

 private:
  uint64_t state_;
};

}  // namespace frond
