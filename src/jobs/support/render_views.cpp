#include "jobs/support/render_views.h"

#include <unistd.h>

#include <filesystem>

#include "core/error.h"
#include "image/spectral_layout.h"
#include "image/tev_packets.h"
#include "jobs/support/display_params.h"

namespace frond {

DisplayChoice display_of(const Arguments& args) {
  DisplayChoice choice = display_choice(args);
  if (choice.display == "tev") choice.display = "";
  return choice;
}

RenderViews::RenderViews(const Arguments& args) : display_(display_of(args)) {
  if (args.given("display-server"))
    server_ = parse_server_address(args.text("display-server"), args.spelled("display-server"));
  else if (args.text("display") == "tev")
    server_ = parse_server_address(kTevAddress, "tev");
  if (!args.flag("preview")) return;
  terminal_ = output_terminal();
  if (!terminal_)
    fail({}, "{}: neither standard error nor standard output is a terminal to draw on", args.spelled("preview"));
}

/// Called after the scene is built, when the film's bands and colour space are known.
void RenderViews::check(const ImageFormat& format) {
  if (!terminal_) return;
  const std::string space = format.space.empty() ? preview_space(format.bands) : format.space;
  if (space.empty()) fail({}, "--preview: these bands do not cover the visible, and are no image");
  terminal_viewer_.emplace(terminal_, space, display_);
}

void RenderViews::begin(const Film& film, const ImageFormat& format, const std::string& output, const Log& log) {
  if (server_) {
    // tev keeps images by name: the process id distinguishes this render from earlier ones.
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
