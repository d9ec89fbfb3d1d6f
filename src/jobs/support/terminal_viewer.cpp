#include "jobs/support/terminal_viewer.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "core/error.h"
#include "image/terminal_image.h"

namespace frond {

/// Standard error is preferred, because standard output may be redirected to a file.
std::FILE* output_terminal() {
  for (std::FILE* stream : {stderr, stdout})
    if (isatty(fileno(stream)) != 0) return stream;
  return nullptr;
}

TerminalViewer::TerminalViewer(std::FILE* terminal, std::string space, DisplayChoice display)
    : terminal_(terminal), space_(std::move(space)), display_(std::move(display)) {
  colors_.check_display(space_, display_.display, display_.view);
}

/// Each character cell shows two pixels, one above the other.
void TerminalViewer::show(const Image& image) {
  winsize size{};
  const bool is_known = ioctl(fileno(terminal_), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0;
  const int columns = is_known ? size.ws_col : 80, rows = is_known ? size.ws_row : 24;
  std::array<size_t, 3> rgb{};
  constexpr std::array kNames{"R", "G", "B"};
  for (size_t c = 0; c < 3; ++c) rgb[c] = image.channel(kNames[c]).value();
  // Lines that have scrolled off the terminal's top cannot be overwritten. The last two lines are left for the
  // progress.
  Image shown = fitted_image(image.selected(rgb, {"R", "G", "B"}), columns, std::max(1, rows - 2));
  colors_.display(shown.pixels, space_, display_.display, display_.view);
  std::string text = lines_ > 0 ? fmt::format("\r\x1b[{}A", lines_) : "\r\x1b[K";
  if (columns != columns_ || rows != rows_) text += "\x1b[J";
  text += terminal_text(shown);
  columns_ = columns, rows_ = rows, lines_ = (shown.height + 1) / 2;
  std::fwrite(text.data(), 1, text.size(), terminal_);
  std::fflush(terminal_);
}

}  // namespace frond
