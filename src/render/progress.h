#pragma once

#include "render/film/statistics.h"

namespace frond {

/// Is told how far a render is, from one thread at a time.
class Progress {
 public:
  virtual ~Progress() = default;
  /// `fraction` of the work, 0 to 1, and what it took so far.
  virtual void update(double fraction, const RenderStatistics& so_far) = 0;
  /// The render has come to its end, or was stopped.
  virtual void finish() {}
};

}  // namespace frond
