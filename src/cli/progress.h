#pragma once

#include <chrono>
#include <string>

#include "render/progress.h"

namespace frond {

/// Texts of progress on standard error. On a terminal: a line that is overwritten five times a second and erased at the
/// end. Elsewhere, such as in a log file: a line every 30 s, which stays. Nothing is written if `quiet`.
class StatusLine {
 public:
  /// `seconds_between_lines`: where standard error is no terminal.
  explicit StatusLine(bool quiet, double seconds_between_lines = 30);
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Whether it is time for the next text. `seconds`: age of the work; short works of a long job have no line that
  /// stays.
  bool is_due(double seconds) const;
  void show(const std::string& text);
  /// Erases the line from a terminal.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool active_, on_terminal_, has_text_ = false;
  Clock::duration between_;
  Clock::time_point last_;  ///< text, or start
};

/// Progress of a render: percentage, rates, remaining time.
class ProgressLine final : public Progress {
 public:
  explicit ProgressLine(bool quiet, double seconds_between_lines = 30) : line_(quiet, seconds_between_lines) {}
  void update(double fraction, const RenderStatistics& so_far) override;
  void finish() override { line_.clear(); }

 private:
  StatusLine line_;
};

}  // namespace frond
