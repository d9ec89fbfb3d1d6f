#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>

#include "core/integrator.h"

namespace frond {

/// Histogram of path lengths: the number of paths that ended after 0, 1, ... scattering events. The last element counts
/// all paths with kDepths - 1 or more events.
struct PathEnds {
  static constexpr size_t kDepths = 64;
  std::array<uint64_t, kDepths> escaped{}, absorbed{};  ///< left the scene; were absorbed or terminated

  void add(const PathResult& path) {
    const size_t depth = std::min(size_t(path.scatterings), kDepths - 1);
    ++(path.escaped ? escaped : absorbed)[depth];
  }
  /// Number of paths with at least `events` scattering events; `events` < kDepths.
  uint64_t alive_after(size_t events) const {
    return std::accumulate(escaped.begin() + events, escaped.end(), uint64_t{0}) +
           std::accumulate(absorbed.begin() + events, absorbed.end(), uint64_t{0});
  }
  PathEnds& operator+=(const PathEnds& other) {
    for (size_t i = 0; i < kDepths; ++i) escaped[i] += other.escaped[i], absorbed[i] += other.absorbed[i];
    return *this;
  }
};

/// Statistics of a render: numbers of paths and rays, and times.
struct RenderStatistics {
  uint64_t paths = 0, rays = 0;
  double wall_seconds = 0, cpu_seconds = 0;
  PathEnds ends;
  std::map<PlugInFault, uint64_t> faults = {};  ///< number of paths with each

  RenderStatistics& operator+=(const RenderStatistics& other) {
    paths += other.paths, rays += other.rays;
    wall_seconds += other.wall_seconds, cpu_seconds += other.cpu_seconds;
    ends += other.ends;
    for (const auto& [fault, count] : other.faults) faults[fault] += count;
    return *this;
  }
};

}  // namespace frond
