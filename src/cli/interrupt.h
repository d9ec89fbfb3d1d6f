#pragma once

#include <stop_token>
#include <thread>

namespace frond {

/// Turns the first SIGINT or SIGTERM into a stop request for the duration of its life. A second SIGINT ends the
/// program; a second SIGTERM is ignored, even after destruction.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Token that is stopped by the signal.
  std::stop_token token() const { return stop_.get_token(); }
  /// Returns the signal received; 0: none.
  int signal() const;

 private:
  std::stop_source stop_;
  std::jthread watcher_;
};

/// SIGINT ends the program, as by default, with a line about --checkpoint. A SIGINT that is ignored remains so.
void advise_checkpoint_on_interrupt();

}  // namespace frond
