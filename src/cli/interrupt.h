#pragma once

#include <stop_token>
#include <thread>

namespace frond {

/// While it lives, the first SIGINT or SIGTERM asks for a stop instead of ending the program; a second SIGINT ends it,
/// a second SIGTERM does not, then or later.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return stop_.get_token(); }
  /// Which one came; 0: none.
  int signal() const;

 private:
  std::stop_source stop_;
  std::jthread watcher_;
};

}  // namespace frond
