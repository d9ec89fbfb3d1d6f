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
  bool predicts = false;    ///< whether amounts follow from the error: `next_check`
};

/// Reason why a refinement ended.
enum class RefineEnd : uint8_t { done, stopped, time_over };

/// Returns the amount of a refinement after `amount`: eight steps to the next power of 2. Each step has multiples of 8,
/// because rays are traced eight at a time.
inline uint64_t next_amount(uint64_t amount) {
  constexpr uint64_t kSteps = 8, kLeastStep = 8;
  return amount + std::max(kLeastStep, std::bit_floor(amount) / kSteps);
}

/// Returns the amount at which to check the error again, if it is `ratio` times the target after `amount`: the steps of
/// `next_amount`, without those before three quarters of what is still missing, as the error falls with the square root
/// of the amount. At most four times the amount, since an error of few samples may be too large. Few large steps take
/// less time than many small ones, because paths that are traced together meet the same parts of a scene.
inline uint64_t next_check(uint64_t amount, double ratio) {
  constexpr double kShare = 0.75, kMostGrowth = 4;
  const double most = double(amount) * std::min(kMostGrowth, 1 + kShare * (ratio * ratio - 1));
  uint64_t next = next_amount(amount);
  while (double(next_amount(next)) <= most) next = next_amount(next);
  return next;
}

/// Calls `measure(amount)`, which extends the measurement to that amount, until `error()` is at most the target, the
/// amount reaches `limits.most`, or the control stops it. `present` is the amount that an earlier run has measured, or
/// with `predicts` the last one that it passed to `measure`; it used the same sequence of amounts, so both give the
/// same result.
template <class Measure, class Error>
RefineEnd refine(RefineLimits limits, uint64_t present, const RenderControl& control, Measure&& measure,
                 Error&& error) {
  const bool refines = limits.target_error > 0;
  uint64_t amount = limits.amount;
  while (refines && amount < present) amount = next_amount(amount);
  for (;;) {
    measure(amount);
    if (control.stop.stop_requested()) return RefineEnd::stopped;
    if (control.deadline && std::chrono::steady_clock::now() >= *control.deadline) return RefineEnd::time_over;
    if (!refines || amount >= limits.most) return RefineEnd::done;
    const double ratio = error() / limits.target_error;
    if (ratio <= 1) return RefineEnd::done;
    amount = limits.predicts ? std::min(next_check(amount, ratio), limits.most) : next_amount(amount);
  }
}

}  // namespace frond
