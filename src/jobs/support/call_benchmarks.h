#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/bench_report.h"

namespace frond {

/// One material under test, hit from one direction.
struct TimedHit {
  std::string material;  ///< name in the benchmark's name
  PathHit hit;

  /// Returns the benchmark's name, in the scheme of frond_bench (docs/performance.md).
  std::string name(BsdfCall call) const;
};

/// Duration of a benchmark.
struct TimingEffort {
  int repetitions = 5;
  double min_time_s = 0.01;  ///< of each repetition
};

/// Times of all calls.
struct CallTimes {
  std::vector<std::array<Estimate, kBsdfCalls.size()>> ns;  ///< CPU time of a call in ns, for each hit
  std::string json;                                         ///< Google Benchmark's JSON output of all repetitions
};

/// Times each call of each hit with Google Benchmark on the calling thread; repetitions are interleaved at random.
/// Throws InputError if frond was built without Google Benchmark.
CallTimes time_calls(std::span<const TimedHit> hits, const TimingEffort& effort);

}  // namespace frond
