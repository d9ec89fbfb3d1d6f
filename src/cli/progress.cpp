#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace frond {
namespace {

/// Limits the rate of output.
constexpr double kSecondsBetweenLines = 0.2;

}  // namespace

TerminalLine::TerminalLine(bool quiet) : active_(!quiet && isatty(STDERR_FILENO) != 0) {}

TerminalLine::~TerminalLine() { clear(); }

/// \x1b[K erases the line from the cursor on.
void TerminalLine::clear() {
  if (active_ && last_shown_ >= 0) std::fputs("\r\x1b[K", stderr);
  last_shown_ = -1;
}

bool TerminalLine::is_due(double seconds) {
  if (!active_ || seconds - last_shown_ < kSecondsBetweenLines) return false;
  last_shown_ = seconds;
  return true;
}

void TerminalLine::show(const std::string& text) {
  std::fputs(("\r\x1b[K" + text).c_str(), stderr);
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
