#pragma once

#include "radiometry/brf.h"

namespace frond {

/// Returns the relative difference of one BRF from another, by view and band. Two measurements of one scene with one
/// seed share part of their noise; differences of rows remove the shared part from the error.
std::vector<MeanError> relative_to(const BrfMeasurement& reference, const BrfMeasurement& measurement);

/// Verdict on whether two measurements agree in every view and band.
struct BrfVerdict {
  enum class Answer : uint8_t { enough, not_enough, unknown };
  Answer answer;
  size_t view, band;  ///< where the difference may be largest
  MeanError worst;
  double upper;  ///< upper bound of the largest difference
};

/// Returns `enough` if all differences are within the limit with 95 % joint confidence, `not_enough` if one exceeds it,
/// else `unknown`. Measurements with heavy tails are always `unknown`.
BrfVerdict check_agreement(const BrfMeasurement& reference, const BrfMeasurement& measurement, double within);

}  // namespace frond
