#pragma once

#include <string>
#include <string_view>

#include "core/error.h"
#include "instruments/errors/statistics.h"
#include "tests/stability/page.h"

namespace frond::stability {

/// Largest accepted error of an estimate in standard errors; a correct one exceeds it with probability 6e-7.
inline constexpr double kMostStandardErrors = 5;

/// A number rounded up to 1, 2 or 5 times a power of ten, so that small rounding differences do not change the text.
std::string rounded_up(double x);

/// Compares shares of light of one method with their true values. Negative values and NaN are always unexpected.
class Comparison {
 public:
  /// `bound`: largest accepted error of the method beside its noise; 0: the method is exact.
  explicit Comparison(double bound = 0) : bound_(bound) {}

  /// A value without noise.
  void add(std::string_view what, double value, double truth);
  /// A mean over `rays`. The bound adds 10 rays to the standard errors, for rare outcomes.
  void add(std::string_view what, const Estimate& value, double truth, int64_t rays);
  /// Any other condition.
  void require(bool holds, std::string_view what);

  Cell cell() const;

 private:
  std::string error_text() const;
  void check(bool holds, std::string_view what, double value, double truth);

  double bound_;
  double largest_error_ = 0, largest_se_ = 0;
  bool has_values_ = false, has_estimates_ = false;
  std::string surprise_;  ///< the first unexpected result
};

/// The cell of an `act` that must throw an InputError whose message contains `part`. `folder`, the path of a temporary
/// folder, is removed from the message.
template <class Act>
Cell refusal(std::string_view part, const Act& act, std::string_view folder = {});

/// The expected result of `refusal`.
inline std::string expect_refusal(std::string_view part) { return fmt::format("refused: ... {} ...", part); }

/// The cell of a message; an empty message means that nothing was thrown.
Cell refusal_cell(std::string_view part, std::string message, std::string_view folder);

template <class Act>
Cell refusal(std::string_view part, const Act& act, std::string_view folder) {
  try {
    act();
    return refusal_cell(part, {}, folder);
  } catch (const InputError& error) {
    return refusal_cell(part, error.what(), folder);
  }
}

}  // namespace frond::stability
