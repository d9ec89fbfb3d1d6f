#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "render/render_loop.h"

namespace frond {

/// How much is measured: a fixed amount, or amounts that double until an error is small enough.
struct RefineLimits {
  uint64_t amount = 0;      ///< of paths, samples or rays; the first one of a refinement
  uint64_t most = 0;        ///< the last one of a refinement
  double target_error = 0;  ///< 0: the fixed amount
};

enum class RefineEnd : uint8_t { done, stopped, time_over };

/// Calls `measure(amount)`, which brings what is measured up to that amount, until `error()` is at most the target, the
/// amount is the most, or the control ends it. `present`: the amount that an earlier run has measured, which then went
/// through the same amounts.
template <class Measure, class Error>
RefineEnd refine(RefineLimits limits, uint64_t present, const RenderControl& control, Measure&& measure,
                 Error&& error) {
  const bool refines = limits.target_error > 0;
  uint64_t amount = limits.amount;
  while (refines && amount < present) amount *= 2;
  for (;; amount *= 2) {
    measure(amount);
    if (control.stop.stop_requested()) return RefineEnd::stopped;
    if (control.deadline && std::chrono::steady_clock::now() >= *control.deadline) return RefineEnd::time_over;
    if (!refines || amount >= limits.most || error() <= limits.target_error) return RefineEnd::done;
  }
}

}  // namespace frond
