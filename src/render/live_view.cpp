#include "render/live_view.h"

#include <chrono>
#include <mutex>

#include "core/error.h"
#include "image/exr.h"
#include "system/machine.h"

namespace frond {

LiveView::LiveView(const Film& film, ImageFormat format, Viewer& viewer, const Log& log)
    : film_(film),
      format_(std::move(format)),
      viewer_(viewer),
      log_(log),
      image_(empty_image(film_, format_)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

LiveView::~LiveView() { end_thread(true); }

void LiveView::finish(bool in_halves) {
  end_thread(false);
  if (has_failed_) return;
  update_image(film_, format_, {}, image_);
  if (in_halves) round_to_halves(image_.pixels);
  show("it may not show the final image");
}

void LiveView::end_thread(bool at_once) {
  if (!thread_.joinable()) return;
  is_left_ = at_once;
  viewer_.end(at_once);
  thread_.request_stop();
  thread_.join();
}

void LiveView::show(std::string_view consequence) try { viewer_.show(image_); } catch (const InputError& error) {
  has_failed_ = true;
  if (!is_left_) log_.warn({}, fmt::format("display: {}; {}", error.what(), consequence));
}

void LiveView::run(const std::stop_token& stop) {
  constexpr std::chrono::milliseconds kLeastPause{250};
  constexpr double kMostShare = 0.01;
  std::mutex none;
  std::unique_lock lock(none);
  const double begin = cpu_seconds();
  while (!stop.stop_requested()) {
    if (!update_image(film_, format_, stop, image_)) return;
    show("the render goes on without it");
    if (has_failed_) return;
    do {
      ended_.wait_for(lock, stop, kLeastPause, [] { return false; });
    } while (!stop.stop_requested() && thread_cpu_seconds() > kMostShare * (cpu_seconds() - begin));
  }
}

}  // namespace frond
