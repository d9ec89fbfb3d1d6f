#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/math/vec.h"

namespace frond {

/// Number of lists of mattes of an image: of channels alpha, CryptoObject and CryptoMaterial.
inline constexpr size_t kMostMattes = 3;

/// Surface, or group of surfaces, that a camera ray hits: the number of an instance, from 1, or -1 - the index of a
/// material; 0: no surface.
using MatteKey = int64_t;

/// Weights of a pixel's samples by the surface that they hit. Sums are exact and do not depend on the order of samples.
class MatteList {
 public:
  struct Entry {
    MatteKey key;
    int64_t weight;  ///< in units of 2^-30
    friend bool operator==(const Entry&, const Entry&) = default;
  };

  void add(MatteKey key, int64_t weight) {
    const auto at = std::ranges::lower_bound(entries_, key, {}, &Entry::key);
    if (at != entries_.end() && at->key == key)
      at->weight += weight;
    else
      entries_.insert(at, {key, weight});
  }
  MatteList& operator+=(const MatteList& other) {
    for (const Entry& e : other.entries_) add(e.key, e.weight);
    return *this;
  }
  /// Ascending keys.
  const std::vector<Entry>& entries() const { return entries_; }
  friend bool operator==(const MatteList&, const MatteList&) = default;

 private:
  std::vector<Entry> entries_;
};

/// Surface that the camera ray of a sample hits, by list.
struct MatteSample {
  std::array<MatteKey, kMostMattes> keys{};
  double weight = 1;  ///< filter weight
  Vec2 place = {};    ///< position in the pixel, [0, 1)^2; used with splatting
};

/// Share of a pixel that a surface covers, weighted by the pixel filter.
struct Matte {
  MatteKey key;
  double coverage;
};

}  // namespace frond
