#pragma once

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdint>

#include "render/render_loop.h"

namespace frond {

/// Amount of a measurement: fixed, or raised until an error is small enough.
struct RefineLimits {
  uint64_t amount = 0;      ///< number of paths, samples or rays; of a refinement, the first amount
  uint64_t most = 0;        ///< largest amount of a refinement
  double target_error = 0;  ///< 0: measure the fixed amount
};

/// Reason why a refinement ended.
enum class RefineEnd : uint8_t { done, stopped, time_over };

/// Returns the amount of a refinement after `amount`: eight steps to the next power of 2. The amounts do not depend on
/// what is measured, so that an interrupted measurement continues to the same result. Each step has multiples of 8,
/// because rays are traced eight at a time.
inline uint64_t next_amount(uint64_t amount) {
  constexpr uint64_t kSteps = 8, kLeastStep = 8;
  return amount + std::max(kLeastStep, std::bit_floor(amount) / kSteps);
}

/// Calls `measure(amount)`, which extends the measurement to that amount, until `error()` is at most the target, the
/// amount reaches `limits.most`, or the control stops it. `present` is the amount that an earlier run has measured;
/// that run used the same sequence of amounts, so both give the same result.
template <class Measure, class Error>
RefineEnd refine(RefineLimits limits, uint64_t present, const RenderControl& control, Measure&& measure,
                 Error&& error) {
  const bool refines = limits.target_error > 0;
  uint64_t amount = limits.amount;
  while (refines && amount < present) amount = next_amount(amount);
  for (;; amount = next_amount(amount)) {
    measure(amount);
    if (control.stop.stop_requested()) return RefineEnd::stopped;
    if (control.deadline && std::chrono::steady_clock::now() >= *control.deadline) return RefineEnd::time_over;
    if (!refines || amount >= limits.most || error() <= limits.target_error) return RefineEnd::done;
  }
}

}  // namespace frond
