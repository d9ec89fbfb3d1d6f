#pragma once

#include <string>
#include <string_view>

#include "core/error.h"
#include "instruments/errors/statistics.h"
#include "tests/stability/page.h"

namespace frond::stability {

/// How far from the truth an estimate may be, in its standard errors: a sound one is further with probability 6e-7.
inline constexpr double kMostStandardErrors = 5;

/// A number rounded up to 1, 2 or 5 times a power of ten: the same text wherever rounding differs a little.
std::string rounded_up(double x);

/// Of shares of light that one method found with the true ones. Negative values and such as are no numbers are
/// surprises, whatever the truth.
class Comparison {
 public:
  /// `bound` on the method's own error; 0: it is exact.
  explicit Comparison(double bound = 0) : bound_(bound) {}

  /// Without noise.
  void add(std::string_view what, double value, double truth);
  /// A mean over `rays`. Where few would have met an outcome, 10 rays are allowed for beside the standard errors.
  void add(std::string_view what, const Estimate& value, double truth, int64_t rays);
  /// Anything else that has to hold.
  void require(bool holds, std::string_view what);

  Cell cell() const;

 private:
  std::string error_text() const;
  void check(bool holds, std::string_view what, double value, double truth);

  double bound_;
  double largest_error_ = 0, largest_se_ = 0;
  bool has_values_ = false, has_estimates_ = false;
  std::string surprise_;  ///< the first
};

/// `act` throws an InputError whose message contains `part`. Words that name a place of this run (a folder) are left
/// out of the text.
template <class Act>
Cell refusal(std::string_view part, const Act& act, std::string_view folder = {});

/// What is expected of it.
inline std::string expect_refusal(std::string_view part) { return fmt::format("refused: ... {} ...", part); }

/// The cell for a message, or for none.
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
