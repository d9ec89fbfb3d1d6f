#pragma once

#include <cmath>
#include <cstdint>

namespace frond {

__extension__ using Int128 = __int128;

/// Sum that does not depend on the order of its terms: a 128-bit fixed-point number with `kFraction` fractional bits.
/// Each term is rounded toward 0 to a multiple of 2^(1 - kFraction); the additions are exact. 2^30 terms below
/// `kLargestTerm` in magnitude cannot overflow the sum.
template <int kFraction>
class ExactSum {
 public:
  static constexpr double kLargestTerm =
      double(uint64_t{1} << 48) * double(uint64_t{1} << 48) / double(uint64_t{1} << kFraction);

  void add(double term) {
    // The integer and the fractional part of the fixed-point number divided by 2^64.
    const double units = term * (double(uint64_t{1} << kFraction) * 0x1p-64);
    const auto whole = static_cast<int64_t>(units);
    const auto rest = static_cast<int64_t>((units - static_cast<double>(whole)) * 0x1p63);
    bits_ += (static_cast<Int128>(whole) << 64) + (static_cast<Int128>(rest) << 1);
  }
  /// Adds n 2^(shift - kFraction) exactly.
  void add_multiple(int64_t n, int shift) { bits_ += static_cast<Int128>(n) << shift; }
  ExactSum& operator+=(const ExactSum& other) {
    bits_ += other.bits_;
    return *this;
  }
  double value() const { return static_cast<double>(bits_) / double(uint64_t{1} << kFraction); }

  friend bool operator==(const ExactSum&, const ExactSum&) = default;

 private:
  Int128 bits_ = 0;
};

}  // namespace frond
