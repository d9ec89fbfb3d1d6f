#pragma once

#include "render/film/statistics.h"

namespace frond {

/// Observer of a render's progress. Called from one thread at a time.
class Progress {
 public:
  virtual ~Progress() = default;
  /// Reports the completed fraction of the work, 0 to 1, and the statistics up to now.
  virtual void update(double fraction, const RenderStatistics& so_far) = 0;
  /// Reports that the render is complete or was stopped.
  virtual void finish() {}
};

}  // namespace frond
