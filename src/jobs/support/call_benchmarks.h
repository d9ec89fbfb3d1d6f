#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/bench_report.h"

namespace frond {

/// What is timed of one material from one direction.
struct TimedHit {
  std::string material;  ///< for names
  PathHit hit;

  /// As frond_bench names its benchmarks (docs/benchmarks.md).
  std::string name(BsdfCall call) const;
};

struct TimingEffort {
  int repetitions = 5;
  double min_time_s = 0.01;  ///< of each repetition
};

struct CallTimes {
  std::vector<std::array<Estimate, kBsdfCalls.size()>> ns;  ///< CPU time of a call, for each hit
  std::string json;                                         ///< what Google Benchmark says of all repetitions
};

/// Times each call of each hit by Google Benchmark, on this thread, all repetitions mixed at random. Throws InputError
/// where frond was built without it.
CallTimes time_calls(std::span<const TimedHit> hits, const TimingEffort& effort);

}  // namespace frond
