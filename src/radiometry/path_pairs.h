#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "core/math/random.h"

namespace frond {

/// Point of the unit square.
using UnitPoint = std::array<double, 2>;

/// Rectangle of the unit square.
struct Stratum {
  UnitPoint corner{0, 0}, size{1, 1};

  /// Returns a uniform point.
  UnitPoint sample(RandomStream& random) const {
    const double x = random.uniform_double(), y = random.uniform_double();
    return {corner[0] + size[0] * x, corner[1] + size[1] * y};
  }
};

/// Returns the stratum in which both paths of a pair begin, each at a point of its own. The sequence of pairs consists
/// of runs: eight of 1 pair, then four each of 2, 4, 8, ... pairs. A run of 2^n pairs has one in each of 2^n strata of
/// equal area. They follow in an order that is random at each level (Owen 1995): each aligned 2^k pairs of a run are in
/// different ones of 2^k larger strata. Differences within pairs do not show what the strata of an incomplete run miss,
/// which is little where runs are a quarter of the pairs before them, or less.
inline Stratum stratum_of(uint64_t pair, uint64_t key) {
  constexpr uint64_t kRuns = 4;  // of each size
  const uint64_t run = std::max<uint64_t>(1, std::bit_floor(pair) / kRuns), first = pair - pair % run;
  Stratum stratum;
  uint64_t order = pair - first, cell = 1;  // the halves chosen so far, below a leading 1
  for (size_t axis = 0; cell < run; axis = 1 - axis) {
    const uint64_t half = (order ^ hash_key(key, first, cell)) & 1;
    order >>= 1;
    cell = 2 * cell + half;
    stratum.size[axis] /= 2;
    stratum.corner[axis] += double(half) * stratum.size[axis];
  }
  return stratum;
}

}  // namespace frond
