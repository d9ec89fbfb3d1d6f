#pragma once

#include <cstdint>
#include <string_view>

namespace frond {

/// Bijective 64-bit mixer (Stafford's variant 13, the finaliser of SplitMix64).
constexpr uint64_t mix64(uint64_t v) {
  v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9ull;
  v = (v ^ (v >> 27)) * 0x94d049bb133111ebull;
  return v ^ (v >> 31);
}

/// Key of everything listed, order mattering. Used for random streams and for content hashes of small records.
template <class... Parts>
constexpr uint64_t hash_key(uint64_t first, Parts... rest) {
  uint64_t h = mix64(first + 0x9e3779b97f4a7c15ull);
  ((h = mix64(h + 0x9e3779b97f4a7c15ull + static_cast<uint64_t>(rest))), ...);
  return h;
}

/// FNV-1a over bytes, then mixed: the content hash of files and parameter text.
constexpr uint64_t hash_bytes(std::string_view bytes, uint64_t seed = 0) {
  uint64_t h = 0xcbf29ce484222325ull ^ seed;
  for (const char c : bytes) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return mix64(h);
}

/// Counter-based random numbers: draw n of a stream depends on its key and n alone (SplitMix64 in counter form), so
/// that results do not depend on threads, tiles or the order in which pixels are rendered.
class RandomStream {
 public:
  explicit constexpr RandomStream(uint64_t key) : state_(key) {}

  constexpr uint64_t bits() { return mix64(state_ += 0x9e3779b97f4a7c15ull); }
  /// Uniform in [0, 1), 24 bits.
  constexpr float uniform() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }
  /// Uniform in [0, 1), 53 bits.
  constexpr double uniform_double() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  /// Uniform in (0, 1), 53 bits: safe under a logarithm.
  constexpr double uniform_open() { return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52; }

 private:
  uint64_t state_;
};

}  // namespace frond
