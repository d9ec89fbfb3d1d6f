#include "cli/interrupt.h"

#include <atomic>
#include <chrono>
#include <csignal>

namespace frond {
namespace {

std::atomic<int> caught = 0;  // a handler may do no more than set it
static_assert(std::atomic<int>::is_always_lock_free);

void remember(int signal) { caught = signal; }

void set_handler(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  // A second SIGINT, of someone who will not wait, has its way; batch systems send SIGTERM twice.
  action.sa_flags = SA_RESTART | (signal == SIGINT ? static_cast<int>(SA_RESETHAND) : 0);
  sigaction(signal, &action, nullptr);
}

}  // namespace

Interrupt::Interrupt() {
  caught = 0;
  for (const int signal : {SIGINT, SIGTERM}) set_handler(signal, remember);
  watcher_ = std::jthread([this](const std::stop_token& end) {
    while (!end.stop_requested() && caught == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (caught != 0) stop_.request_stop();
  });
}

Interrupt::~Interrupt() {
  if (caught != 0) return;  // the program ends, and says so by its own exit code
  for (const int signal : {SIGINT, SIGTERM}) set_handler(signal, SIG_DFL);
}

int Interrupt::signal() const { return caught; }

}  // namespace frond
