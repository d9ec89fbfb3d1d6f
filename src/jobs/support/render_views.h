#pragma once

#include <optional>
#include <string>

#include "core/log.h"
#include "jobs/record/arguments.h"
#include "jobs/support/terminal_viewer.h"
#include "render/live_view.h"
#include "render/tev_viewer.h"

namespace frond {

/// Of --display and --view.
DisplayChoice display_of(const Arguments& args);

/// Where a render is shown while it runs, by --display-server and --preview.
class RenderViews {
 public:
  /// Throws InputError for an address that is none, and for a preview where there is no terminal.
  explicit RenderViews(const Arguments& args);

  /// Throws InputError for a preview of bands that have no colours, or by a display that does not go with them.
  void check(const ImageFormat& format);
  /// `film` and `log` must outlive it; the log is called from other threads. `output`: where the film goes.
  void begin(const Film& film, const ImageFormat& format, const std::string& output, const Log& log);
  /// The preview as it is in the end.
  void finish_preview();
  /// The image in the viewer as it is in the end, for which it is given a few seconds. `in_halves`: as the file has
  /// it.
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
