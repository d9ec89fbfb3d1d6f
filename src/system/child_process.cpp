#include "system/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <sstream>
#include <thread>

#include "core/error.h"
#include "core/parallel.h"

extern char** environ;

namespace frond {
namespace {

/// Unnamed temporary file for one of the child's streams. Unlike a pipe it has no limited buffer, so that parent and
/// child cannot block each other.
class StreamFile {
 public:
  StreamFile() : file_(std::tmpfile(), &std::fclose) {
    if (!file_) fail({}, "cannot make a temporary file: {}", std::strerror(errno));
  }
  int descriptor() const { return fileno(file_.get()); }

  void fill(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() || std::fflush(file_.get()) != 0)
      fail({}, "cannot write a temporary file: {}", std::strerror(errno));
    std::rewind(file_.get());
  }
  std::string content() {
    std::rewind(file_.get());
    std::string text;
    std::array<char, 65536> buffer;
    for (size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), file_.get())) > 0;) text.append(buffer.data(), n);
    return text;
  }

 private:
  std::unique_ptr<FILE, int (*)(FILE*)> file_;
};

/// Pipe whose two ends are closed in programs that this process starts, unless they are passed to them.
struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) fail({}, "cannot make a pipe: {}", std::strerror(errno));
    reader = ends[0], writer = ends[1];
  }
  ~Pipe() {
    close(reader);
    close(writer);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int reader = -1, writer = -1;
};

/// Returns the child's status; a signal does not end the wait.
int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// Starts a program with these descriptors as its first ones. Returns nothing if there is no such program.
std::optional<pid_t> start(const std::vector<std::string>& command, std::span<const int> descriptors) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (int i = 0; i < int(descriptors.size()); ++i)
    posix_spawn_file_actions_adddup2(&actions, descriptors[size_t(i)], i);
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  // Signals that this process ignores or blocks have their default meaning in the child.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t ignored;
  sigemptyset(&ignored);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGINT}) sigaddset(&ignored, signal);
  posix_spawnattr_setsigdefault(&attributes, &ignored);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  pid_t child = 0;
  const int error = posix_spawnp(&child, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT) return {};
  if (error != 0) fail({}, "cannot run {}: {}", command[0], std::strerror(error));
  return child;
}

volatile std::sig_atomic_t attached_child = 0;

/// While it exists, SIGINT is ignored, because a terminal sends it to the child too, and requests to end are passed on
/// to the child.
class SignalsOfChild {
 public:
  SignalsOfChild() {
    attached_child = 0;
    set(SIGINT, SIG_IGN, before_[0]);
    // A request that comes before the child is known has no effect, so that it is blocked until then.
    sigemptyset(&requests_);
    for (size_t i = 0; i < kRequests.size(); ++i) {
      sigaddset(&requests_, kRequests[i]);
      set(kRequests[i], forward_signal, before_[i + 1]);
    }
    pthread_sigmask(SIG_BLOCK, &requests_, nullptr);
  }
  ~SignalsOfChild() {
    sigaction(SIGINT, &before_[0], nullptr);
    for (size_t i = 0; i < kRequests.size(); ++i) sigaction(kRequests[i], &before_[i + 1], nullptr);
    pthread_sigmask(SIG_UNBLOCK, &requests_, nullptr);
    attached_child = 0;
  }
  SignalsOfChild(const SignalsOfChild&) = delete;
  SignalsOfChild& operator=(const SignalsOfChild&) = delete;

  void forward_to(pid_t child) const {
    attached_child = child;
    pthread_sigmask(SIG_UNBLOCK, &requests_, nullptr);
  }

 private:
  static constexpr std::array kRequests{SIGTERM, SIGHUP};

  /// A signal that is ignored, as SIGHUP under nohup, stays so, here and in the child.
  static void set(int signal, void (*handler)(int), struct sigaction& before) {
    struct sigaction action {};
    action.sa_handler = handler;
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  static void forward_signal(int signal) {
    if (attached_child > 0) kill(pid_t(attached_child), signal);
  }

  std::array<struct sigaction, 1 + kRequests.size()> before_{};
  sigset_t requests_{};
};

}  // namespace

std::optional<ChildResult> run_child(const std::vector<std::string>& command, const std::string& input) {
  std::array<StreamFile, 3> streams;
  streams[0].fill(input);
  const auto child =
      start(command, std::array{streams[0].descriptor(), streams[1].descriptor(), streams[2].descriptor()});
  if (!child) return {};
  const int status = wait_for(*child);
  return ChildResult{status, streams[1].content(), streams[2].content()};
}

std::optional<ChildResult> run_dependent(const std::vector<std::string>& command) {
  Pipe input;
  std::array<StreamFile, 2> streams;
  const auto child = start(command, std::array{input.reader, streams[0].descriptor(), streams[1].descriptor()});
  if (!child) return {};
  int status = 0;
  for (auto pause = std::chrono::milliseconds(1); waitpid(*child, &status, WNOHANG) == 0;) {
    if (is_stop_requested()) {
      kill(*child, SIGKILL);
      wait_for(*child);
      throw Stopped();
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::milliseconds(20));
  }
  return ChildResult{status, streams[0].content(), streams[1].content()};
}

std::optional<int> run_attached(const std::vector<std::string>& command, const std::filesystem::path& output) {
  std::unique_ptr<FILE, int (*)(FILE*)> file(output.empty() ? nullptr : std::fopen(output.c_str(), "we"), &std::fclose);
  if (!output.empty() && !file) fail({}, "cannot write \"{}\": {}", output.string(), std::strerror(errno));
  std::vector<int> descriptors;
  if (file) descriptors = {STDIN_FILENO, fileno(file.get()), fileno(file.get())};
  const SignalsOfChild signals;
  const auto child = start(command, descriptors);
  if (!child) return {};
  signals.forward_to(*child);
  return wait_for(*child);
}

bool is_in_path(const std::string& program) {
  const char* variable = std::getenv("PATH");
  std::istringstream folders(variable ? variable : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder.empty() ? program : folder + "/" + program).c_str(), X_OK) == 0) return true;
  return false;
}

std::string exit_text(int status) {
  if (WIFSIGNALED(status)) return fmt::format("signal {}", WTERMSIG(status));
  return fmt::format("exit code {}", WEXITSTATUS(status));
}

}  // namespace frond
