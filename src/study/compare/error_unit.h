#pragma once

#include "study/compare/channels.h"

namespace frond::compare {

/// A number with so many significant figures, as people write it: 1230, not 1.23e+03.
std::string figures(double value, int count);

/// The unit in which errors are reported. An absolute error has the unit of the channels. A relative one is the RMS
/// over a region's pixels divided by the reference's mean over the same pixels in the same channel: a share in data
/// files and where the user asks for one (0.05), per cent where people read it (5 %).
class ErrorUnit {
 public:
  explicit ErrorUnit(bool relative) : relative_(relative) {}

  bool is_relative() const { return relative_; }
  /// The unit of errors in data files.
  std::string of_data(const ChannelList& channels) const;
  /// What an axis of a chart counts, and an error on it.
  std::string of_axis(const ChannelList& channels) const;
  double on_axis(double error) const { return relative_ ? 100 * error : error; }
  /// "an RMS", of this kind.
  std::string rms() const { return relative_ ? "a relative RMS" : "an RMS"; }

  // An error as people read it.
  /// With so many decimals; of per cent with two.
  std::string fixed(double error, int decimals) const;
  /// With two significant figures.
  std::string rounded(double error) const;
  /// As it was asked for.
  std::string as_asked(double error) const;

 private:
  bool relative_;
};

/// What relative errors are.
inline constexpr const char* kRelativeExplained =
    "Errors are relative: each channel’s RMS over the mean of the reference in the same channel and over the same "
    "pixels; of all channels together the root of the mean square of these.";

}  // namespace frond::compare
