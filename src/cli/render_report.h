#pragma once

#include <optional>
#include <string>

#include "render/part.h"
#include "study/choose/choice.h"

namespace frond {

/// One thing that was rendered.
struct RenderReport {
  RenderStatistics statistics;  ///< of this run
  double load_seconds;
  SampleCount samples;
  double foliar_ratio;
  double error_tail;  ///< ErrorTail's share
  std::optional<choose::Choice> choice;
  std::string output;
};

/// For people, on standard error, or as JSON on standard output.
void print_report(const RenderReport& report, bool json);

}  // namespace frond
