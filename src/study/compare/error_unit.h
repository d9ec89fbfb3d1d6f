#pragma once

#include "study/compare/channels.h"

namespace frond::compare {

/// Returns a number with `count` significant figures and without an exponent: 1230, not 1.23e+03.
std::string figures(double value, int count);

/// Unit of reported errors. An absolute error has the unit of the channels. A relative error is the RMS over a region's
/// pixels divided by the reference's mean over the same pixels and channel: a fraction in data files and arguments
/// (0.05), per cent in reports (5 %).
class ErrorUnit {
 public:
  explicit ErrorUnit(bool relative) : relative_(relative) {}

  bool is_relative() const { return relative_; }
  /// Returns the unit of errors in data files.
  std::string data_unit(const ChannelList& channels) const;
  /// Returns the unit of errors on a chart's axis.
  std::string axis_unit(const ChannelList& channels) const;
  double axis_value(double error) const { return relative_ ? 100 * error : error; }
  /// Returns "an RMS" or "a relative RMS".
  std::string rms() const { return relative_ ? "a relative RMS" : "an RMS"; }

  // Errors as text in reports.
  /// Returns the error with `decimals` decimals; per cent with two.
  std::string fixed(double error, int decimals) const;
  /// Returns the error with two significant figures.
  std::string rounded(double error) const;
  /// Returns the error in the unit of arguments.
  std::string in_argument_unit(double error) const;

 private:
  bool relative_;
};

/// Definition of relative errors, for reports.
inline constexpr const char* kRelativeExplained =
    "Errors are relative: each channel’s RMS over the mean of the reference in the same channel and over the same "
    "pixels; of all channels together the root of the mean square of these.";

}  // namespace frond::compare
