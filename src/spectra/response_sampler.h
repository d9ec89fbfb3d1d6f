#pragma once

#include <vector>

#include "core/error.h"
#include "core/spectrum.h"

namespace frond {

/// Draws wavelengths in proportion to a sensor's response.
class ResponseSampler {
 public:
  /// Throws InputError at `where` where the response is 0 everywhere.
  ResponseSampler(SpectrumPtr response, const Location& where);

  struct Sample {
    float nm;
    float weight;  ///< times radiance at `nm`: an estimate of the mean radiance under the response; near 1
  };
  /// u in [0, 1).
  Sample sample(float u) const;
  /// Where the response is not 0, to a thousandth of its table's width; no sample leaves it.
  Interval support_nm() const { return support_nm_; }
  double centroid_nm() const { return centroid_nm_; }

 private:
  double edge(size_t cell) const { return first_nm_ + double(cell) * cell_nm_; }

  SpectrumPtr response_;
  double first_nm_, cell_nm_, area_ = 0, centroid_nm_ = 0;
  std::vector<double> cumulative_;  ///< share of the response below the end of each cell
  Interval support_nm_{};
};

}  // namespace frond
