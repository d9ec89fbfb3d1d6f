#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace frond {
namespace {

constexpr double kSecondsBetweenLines = 0.2;

}  // namespace

ProgressLine::ProgressLine(bool quiet) : active_(!quiet && isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
  if (active_) fmt::print(stderr, "\r\x1b[K");
}

void ProgressLine::operator()(double fraction, const RenderStatistics& s) {
  if (!active_ || s.wall_seconds - last_shown_ < kSecondsBetweenLines) return;
  last_shown_ = s.wall_seconds;
  const double left = fraction > 0 ? s.wall_seconds * (1 - fraction) / fraction : 0;
  fmt::print(stderr, "\r\x1b[K{:5.1f} %  {:.1f} M samples  {:.2f} M rays/s  {:.0f} s left", 100 * fraction,
             double(s.paths) * 1e-6, double(s.rays) / s.wall_seconds * 1e-6, left);
  std::fflush(stderr);
}

}  // namespace frond
