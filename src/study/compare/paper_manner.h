#pragma once

#include <optional>

#include "study/compare/comparison.h"
#include "study/compare/study.h"

namespace frond::compare {

/// Renders in the manner of Baranoski and Rokne. Light sampling ignores a surface lobe. A path ends when the luminance
/// of its attenuation falls below a cutoff: 0.01 for the baseline, whose trees end at the depth where the ratio of
/// unshot to shot rays is 1e-4. Other candidates end at the same depth, with the cutoff that leaves the same ratio.
class PaperManner {
 public:
  /// Pilots with `pilot_samples` samples per pixel estimate how paths end.
  PaperManner(const Study& study, const Candidate& baseline, uint64_t pilot_samples);

  /// Returns the timing to make; nullopt if the integrator of the scene or the candidate has no cutoff.
  std::optional<PaperTiming> timing(const Candidate& candidate) const;

 private:
  const Study& study_;
  uint64_t pilot_samples_;
  double depth_ = 0;
  UnshotRatio target_ = {};  ///< ratio that the baseline leaves at that depth
};

}  // namespace frond::compare
