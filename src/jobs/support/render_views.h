#pragma once

#include <optional>
#include <string>

#include "core/log.h"
#include "jobs/record/arguments.h"
#include "jobs/support/terminal_viewer.h"
#include "render/live_view.h"
#include "render/tev_viewer.h"

namespace frond {

/// Returns the choice of --display and --view; tev is not a display.
DisplayChoice display_of(const Arguments& args);

/// Viewers of a render in progress: --display-server and --preview.
class RenderViews {
 public:
  /// Throws InputError for an invalid address, and for a preview without a terminal.
  explicit RenderViews(const Arguments& args);

  /// Throws InputError if a preview cannot show the format: bands without colours, or a display of another colour
  /// space.
  void check(const ImageFormat& format);
  /// Starts the viewers. `film` and `log` must outlive this object; the log is called from other threads. `output` is
  /// the image's path.
  void begin(const Film& film, const ImageFormat& format, const std::string& output, const Log& log);
  /// Draws the final image in the terminal.
  void finish_preview();
  /// Sends the final image to the viewer; waits a few seconds at most. `in_halves`: rounded to half precision as in the
  /// file.
  void finish_display(bool in_halves);

 private:
  DisplayChoice display_;
  std::optional<ServerAddress> server_;
  std::FILE* terminal_ = nullptr;
  std::optional<TevViewer> tev_viewer_;
  std::optional<TerminalViewer> terminal_viewer_;
  std::optional<LiveView> on_server_, on_terminal_;
};

}  // namespace frond
