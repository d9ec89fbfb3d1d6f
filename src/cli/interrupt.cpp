#include "cli/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>

namespace frond {
namespace {

std::atomic<int> caught = 0;  // a signal handler may only set a lock-free atomic
static_assert(std::atomic<int>::is_always_lock_free);

void record_signal(int signal) { caught = signal; }

/// Ends the program: the handler is reset on entry, and the second signal is delivered when it returns.
void advise_checkpoint(int signal) {
  constexpr char kText[] = "\nfrond: stopped; the result so far is lost: --checkpoint SECONDS keeps it\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kText, sizeof kText - 1);
  std::raise(signal);
}

/// Installs a handler. SA_RESTART continues interrupted system calls, so that writes are not cut off.
void set_handler(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  // A second SIGINT ends the program at once. A second SIGTERM does not, because batch systems send SIGTERM twice.
  action.sa_flags = SA_RESTART | (signal == SIGINT ? static_cast<int>(SA_RESETHAND) : 0);
  sigaction(signal, &action, nullptr);
}

}  // namespace

Interrupt::Interrupt() {
  caught = 0;
  for (const int signal : {SIGINT, SIGTERM}) set_handler(signal, record_signal);
  struct sigaction hangup {};
  // The terminal was closed; nohup ignores it.
  if (sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler != SIG_IGN) set_handler(SIGHUP, record_signal);
  // The stop is requested from a thread, because request_stop() is not safe in a signal handler.
  watcher_ = std::jthread([this](const std::stop_token& end) {
    while (!end.stop_requested() && caught == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (caught != 0) stop_.request_stop();
  });
}

Interrupt::~Interrupt() {
  if (caught != 0) return;  // the program ends with the signal's exit code
  for (const int signal : {SIGINT, SIGTERM}) set_handler(signal, SIG_DFL);
}

int Interrupt::signal() const { return caught; }

void advise_checkpoint_on_interrupt() {
  struct sigaction now {};
  if (sigaction(SIGINT, nullptr, &now) == 0 && now.sa_handler != SIG_IGN) set_handler(SIGINT, advise_checkpoint);
}

}  // namespace frond
