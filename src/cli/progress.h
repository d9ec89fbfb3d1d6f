#pragma once

#include "integrators/render.h"

namespace frond {

/// A line on a terminal's standard error that says how far the render is; nothing when it is piped or `quiet`.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void operator()(double fraction, const RenderStatistics& so_far);

 private:
  bool active_;
  double last_shown_ = -1;
};

}  // namespace frond
