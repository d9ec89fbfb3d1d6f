#pragma once

#include "study/compare/comparison.h"

namespace frond::compare {

/// A ratio of CPU times, baseline over candidate.
struct Ratio {
  enum class Kind : uint8_t {
    measured,
    extrapolated,       ///< at least one of the two times lies beyond the last run
    not_reached,        ///< the candidate's bias exceeds the error
    baseline_not_there  ///< the baseline's bias exceeds the error
  };
  Kind kind;
  double value = 0;
};

/// Four definitions of a candidate's speed-up over the baseline, which is the first candidate.
struct SpeedUps {
  double equal_samples;                      ///< (a) at equal samples
  std::optional<double> paper;               ///< (b) in the paper's manner
  std::optional<Ratio> equal_error;          ///< (c) all three channels meet `Request::target`
  std::optional<Ratio> equal_error_at_bias;  ///< (c) at 1.5 times the candidate's RMS bias
  double equal_noise;                        ///< (d) at equal variance
};

SpeedUps speed_ups(const Comparison& comparison, size_t index);

}  // namespace frond::compare
