#pragma once

#include <optional>

#include "study/compare/comparison.h"
#include "study/compare/study.h"

namespace frond::compare {

/// Renders as Baranoski and Rokne do. Light sampling does not see a surface lobe. A path ends when the luminance of its
/// attenuation falls below a cutoff: 0.01 for the baseline, whose trees end at the depth where 1e-4 is left of unshot
/// to shot rays. Those of the others end there too, and their cutoff is such that the same is left.
class PaperManner {
 public:
  /// How paths end is estimated by pilots of so many samples per pixel.
  PaperManner(const Study& study, const Candidate& baseline, uint64_t pilot_samples);

  /// What to time. Nothing where the scene's integrator, or the candidate's own, has no such end.
  std::optional<PaperTiming> of(const Candidate& candidate) const;

 private:
  const Study& study_;
  uint64_t pilot_samples_;
  double depth_ = 0;
  UnshotRatio target_ = {};  ///< what the baseline leaves there
};

}  // namespace frond::compare
