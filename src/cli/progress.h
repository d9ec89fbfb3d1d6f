#pragma once

#include <string>

#include "render/progress.h"

namespace frond {

/// A status line on standard error, overwritten in place and erased at the end. Nothing is written if standard error is
/// not a terminal or if `quiet`.
class TerminalLine {
 public:
  explicit TerminalLine(bool quiet);
  ~TerminalLine();
  TerminalLine(const TerminalLine&) = delete;
  TerminalLine& operator=(const TerminalLine&) = delete;

  /// Whether 0.2 s have passed since the last text. `seconds`: time since the start.
  bool is_due(double seconds);
  void show(const std::string& text);
  void clear();

 private:
  bool active_;
  double last_shown_ = -1;
};

/// Progress of a render: percentage, rates, remaining time.
class ProgressLine final : public Progress {
 public:
  explicit ProgressLine(bool quiet) : line_(quiet) {}
  void update(double fraction, const RenderStatistics& so_far) override;
  void finish() override { line_.clear(); }

 private:
  TerminalLine line_;
};

}  // namespace frond
