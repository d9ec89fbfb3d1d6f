#include "tests/stability/comparison.h"

#include <algorithm>
#include <cmath>

namespace frond::stability {
namespace {

/// Tolerance for rounding in double precision.
constexpr double kRounding = 1e-12;

/// Smaller errors depend on the compiler and its library.
constexpr double kLeastToTell = 1e-6, kLeastSe = 1e-8;

}  // namespace

std::string rounded_up(double x) {
  if (!(x > 0)) return "0";
  const int exponent = static_cast<int>(std::floor(std::log10(x)));
  for (const int digit : {1, 2, 5})
    if (x <= digit * std::pow(10, exponent) * (1 + 1e-6)) return fmt::format("{}e{}", digit, exponent);
  return fmt::format("1e{}", exponent + 1);
}

void Comparison::check(bool holds, std::string_view what, double value, double truth) {
  if (value >= 0 && holds) return;
  if (surprise_.empty()) surprise_ = fmt::format("{} is {:.6g}, the truth is {:.6g}", what, value, truth);
}

void Comparison::add(std::string_view what, double value, double truth) {
  const double error = std::abs(value - truth);
  check(error <= bound_ + kRounding, what, value, truth);
  has_values_ = true;
  largest_error_ = std::max(largest_error_, error);
}

void Comparison::add(std::string_view what, const Estimate& value, double truth, int64_t rays) {
  const double se = value.standard_error();
  const double allowed = kMostStandardErrors * se + 10 / static_cast<double>(rays) + bound_;
  check(std::abs(value.mean - truth) <= allowed, what, value.mean, truth);
  has_estimates_ = true;
  largest_se_ = std::max(largest_se_, se);
}

void Comparison::require(bool holds, std::string_view what) {
  if (!holds && surprise_.empty()) surprise_ = what;
}

std::string Comparison::error_text() const {
  if (largest_error_ <= kRounding) return "exact";
  if (largest_error_ > kLeastToTell) return "error " + rounded_up(largest_error_);
  return "error below " + rounded_up(std::min(kLeastToTell, bound_));
}

Cell Comparison::cell() const {
  if (!surprise_.empty()) return {surprise_, true};
  if (has_estimates_) return {largest_se_ > kLeastSe ? "exact, se " + rounded_up(largest_se_) : "exact"};
  return {has_values_ ? error_text() : "holds"};
}

Cell refusal_cell(std::string_view part, std::string message, std::string_view folder) {
  if (message.empty()) return {fmt::format("accepted, not refused with: {}", part), true};
  if (const size_t place = message.find(folder); !folder.empty() && place != message.npos)
    message.erase(place, folder.size());
  return {fmt::format("refused: {}", message), message.find(part) == message.npos};
}

}  // namespace frond::stability
