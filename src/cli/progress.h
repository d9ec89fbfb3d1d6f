#pragma once

#include <string>

#include "render/progress.h"

namespace frond {

/// A line on a terminal's standard error that is written over and over, and gone at the end; nothing when it is piped
/// or `quiet`.
class TerminalLine {
 public:
  explicit TerminalLine(bool quiet);
  ~TerminalLine();
  TerminalLine(const TerminalLine&) = delete;
  TerminalLine& operator=(const TerminalLine&) = delete;

  /// Whether it is time for a new text, `seconds` after the start.
  bool is_due(double seconds);
  void show(const std::string& text);
  void clear();

 private:
  bool active_;
  double last_shown_ = -1;
};

/// How far a render is.
class ProgressLine final : public Progress {
 public:
  explicit ProgressLine(bool quiet) : line_(quiet) {}
  void update(double fraction, const RenderStatistics& so_far) override;
  void finish() override { line_.clear(); }

 private:
  TerminalLine line_;
};

}  // namespace frond
