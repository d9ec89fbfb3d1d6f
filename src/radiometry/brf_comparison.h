#pragma once

#include "radiometry/brf.h"

namespace frond {

/// By how much one BRF lies above another, relative to it: view by view, band by band. Measurements of one scene with
/// one seed share their noise in part; row by row it is known how much, and that does not count.
std::vector<MeanError> relative_to(const BrfMeasurement& reference, const BrfMeasurement& measurement);

/// Whether a reading is near enough to another everywhere.
struct BrfVerdict {
  enum class Answer : uint8_t { enough, not_enough, unknown };
  Answer answer;
  size_t view, band;  ///< where it may be furthest off
  MeanError worst;
  double upper;  ///< bound of the largest difference that there may be
};

/// `enough`: all differences lie within the limit, with 95 % confidence for all of them together; `not_enough`: one
/// lies beyond it. Of
/// measurements with heavy tails nothing is known.
BrfVerdict judge(const BrfMeasurement& reference, const BrfMeasurement& measurement, double within);

}  // namespace frond
