#pragma once

#include "study/compare/comparison.h"

namespace frond::compare {

/// A ratio of CPU times, the baseline's over the candidate's.
struct Ratio {
  enum class Kind : uint8_t {
    measured,
    extrapolated,       ///< one of the two was taken beyond its last run
    not_reached,        ///< the candidate's bias lies above the error
    baseline_not_there  ///< the baseline's does
  };
  Kind kind;
  double value = 0;
};

/// The four ways of telling how much faster a candidate is than the baseline, the first candidate.
struct SpeedUps {
  double equal_samples;                      ///< (a)
  std::optional<double> paper;               ///< (b) in the paper's manner
  std::optional<Ratio> equal_error;          ///< (c) where all three channels meet `Request::target`
  std::optional<Ratio> equal_error_at_bias;  ///< (c) where the RMS of all is 1.5 times the candidate's bias
  double equal_noise;                        ///< (d) at the same variance
};

SpeedUps speed_ups(const Comparison& comparison, size_t index);

}  // namespace frond::compare
