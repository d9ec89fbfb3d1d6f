#include "cli/render_views.h"

#include <unistd.h>

#include <filesystem>

#include "core/error.h"
#include "image/spectral_layout.h"

namespace frond {

RenderViews::RenderViews(const RenderOptions& options) : display_(options.display) {
  if (options.display_server) server_ = parse_server_address(*options.display_server, "--display-server");
  if (!options.preview) return;
  terminal_ = output_terminal();
  if (!terminal_) fail({}, "--preview: neither standard error nor standard output is a terminal to draw on");
}

void RenderViews::check(const PictureFormat& format) {
  if (!terminal_) return;
  const std::string space = format.space.empty() ? preview_space(format.bands) : format.space;
  if (space.empty()) fail({}, "--preview: these bands do not cover the visible, and are no picture");
  terminal_viewer_.emplace(terminal_, space, display_);
}

void RenderViews::begin(const Film& film, const PictureFormat& format, const std::string& output, const Log& log) {
  if (server_) {
    // The process tells a render from those before it, which the viewer keeps.
    const std::string name = std::filesystem::path(output).filename().string();
    tev_viewer_.emplace(*server_, fmt::format("{} ({})", name, getpid()));
    on_server_.emplace(film, format, *tev_viewer_, log);
  }
  if (terminal_viewer_) on_terminal_.emplace(film, format, *terminal_viewer_, log);
}

void RenderViews::finish_preview() {
  if (on_terminal_) on_terminal_->finish(false);
}

void RenderViews::finish_display(bool in_halves) {
  if (on_server_) on_server_->finish(in_halves);
}

}  // namespace frond
