#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace frond {

StatusLine::StatusLine(bool quiet, double seconds_between_lines)
    : active_(!quiet), on_terminal_(isatty(STDERR_FILENO) != 0), last_(Clock::now()) {
  constexpr double kOnTerminal = 0.2;
  const std::chrono::duration<double> between(on_terminal_ ? kOnTerminal : seconds_between_lines);
  between_ = std::chrono::duration_cast<Clock::duration>(between);
}

StatusLine::~StatusLine() { clear(); }

/// \x1b[K erases the line from the cursor on.
void StatusLine::clear() {
  if (has_text_ && on_terminal_) std::fputs("\r\x1b[K", stderr);
  has_text_ = false;
}

bool StatusLine::is_due(double seconds) const {
  return active_ && Clock::now() - last_ >= between_ &&
         (on_terminal_ || std::chrono::duration<double>(seconds) >= between_);
}

void StatusLine::show(const std::string& text) {
  last_ = Clock::now();
  has_text_ = true;
  std::fputs((on_terminal_ ? "\r\x1b[K" + text : text + '\n').c_str(), stderr);
  std::fflush(stderr);
}

/// "samples" are paths, which not all work consists of; the remaining time assumes a constant rate.
void ProgressLine::update(double fraction, const RenderStatistics& s) {
  if (!line_.is_due(s.wall_seconds)) return;
  const double left = fraction > 0 ? s.wall_seconds * (1 - fraction) / fraction : 0;
  if (s.paths == 0) {
    line_.show(fmt::format("{:5.1f} %  {:.0f} s left", 100 * fraction, left));
    return;
  }
  line_.show(fmt::format("{:5.1f} %  {:.1f} M samples  {:.2f} M rays/s  {:.0f} s left", 100 * fraction,
                         double(s.paths) * 1e-6, double(s.rays) / s.wall_seconds * 1e-6, left));
}

}  // namespace frond
