#pragma once

#include <atomic>
#include <condition_variable>
#include <thread>

#include "core/log.h"
#include "render/film/image_format.h"

namespace frond {

/// Whom a render is shown to while it runs.
class Viewer {
 public:
  virtual ~Viewer() = default;
  /// The whole image, linear, as it is by now. Called from one thread at a time. Throws InputError where it can be
  /// shown no more.
  virtual void show(const Image& image) = 0;
  /// Called from another thread at the end: `show` shall be over in a few seconds, or, where nobody waits for it, now.
  virtual void end(bool at_once) = 0;
};

/// Shows a film while it is rendered, four times a second at most, by a thread of its own, which goes on once what it
/// has taken is below a hundredth of the process's CPU time. A viewer that fails is a warning, and shown nothing more.
class LiveView {
 public:
  /// `film` and `viewer` must outlive it. The log is called from that thread.
  LiveView(const Film& film, ImageFormat format, Viewer& viewer, const Log& log);
  /// Ends it. What was shown last stays.
  ~LiveView();

  /// Shows what the film holds in the end, once nothing is rendered any more. `in_halves`: rounded to what such a file
  /// keeps.
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
  std::atomic<bool> is_left_ = false;  ///< what fails now is no news
  std::condition_variable_any ended_;
  std::jthread thread_;  // last: it begins when all else is there
};

}  // namespace frond
