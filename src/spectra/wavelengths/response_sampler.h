#pragma once

#include <span>
#include <vector>

#include "core/error.h"
#include "core/wavelengths.h"

namespace frond {

/// Draws wavelengths in proportion to a sensor's response.
class ResponseSampler {
 public:
  /// The response is linear between the points, whose wavelengths ascend, and 0 beyond them. Throws InputError at
  /// `where` where it is 0 everywhere.
  ResponseSampler(std::vector<ResponsePoint> points, const Location& where);

  /// A wavelength (nm) whose density is the response over its integral. u in [0, 1].
  float sample(float u) const;
  /// No sample leaves it.
  Interval support_nm() const { return support_nm_; }
  double centroid_nm() const { return centroid_nm_; }

 private:
  std::vector<ResponsePoint> points_;
  std::vector<double> cumulative_;  ///< integral of the response up to the end of each cell between points
  Interval support_nm_{};
  double centroid_nm_ = 0;
};

/// Without the zeros at either end, but for the one next to the rest: tables of sensors are often padded with them.
std::vector<ResponsePoint> without_margins(std::span<const ResponsePoint> points);

}  // namespace frond
