#pragma once

#include <atomic>
#include <condition_variable>
#include <thread>

#include "core/log.h"
#include "render/film/image_format.h"

namespace frond {

/// Viewer of a render in progress.
class Viewer {
 public:
  virtual ~Viewer() = default;
  /// Displays the whole image, linear, in its current state. Called from one thread at a time. Throws InputError if the
  /// viewer cannot display images any more.
  virtual void show(const Image& image) = 0;
  /// Called from another thread at the end of the render: a call of `show` must return within a few seconds, or, with
  /// `at_once`, immediately.
  virtual void end(bool at_once) = 0;
};

/// Sends a film to a viewer while it is rendered, from a separate thread, at most four times a second. The thread
/// pauses until its CPU time is below 1 % of the process's. If the viewer fails, a warning is logged and no further
/// image is sent.
class LiveView {
 public:
  /// Starts the thread, which also calls `log`. `film`, `viewer` and `log` must outlive the object.
  LiveView(const Film& film, ImageFormat format, Viewer& viewer, const Log& log);
  /// Stops the thread. The viewer keeps the last image.
  ~LiveView();

  /// Displays the final image; call it after the render. With `in_halves`, values are rounded to 16-bit floats first.
  void finish(bool in_halves);

 private:
  void run(const std::stop_token& stop);
  void show(std::string_view consequence);
  void end_thread(bool at_once);

  const Film& film_;
  ImageFormat format_;
  Viewer& viewer_;
  const Log& log_;
  Image image_;
  bool has_failed_ = false;
  std::atomic<bool> is_left_ = false;  ///< errors are no longer reported
  std::condition_variable_any ended_;
  std::jthread thread_;  // the last member: it starts after the others are initialized
};

}  // namespace frond
