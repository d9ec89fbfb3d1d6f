#include "system/child_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <thread>

#include "core/parallel.h"

namespace frond {
namespace {

/// Runs `command` attached in a separate process, whose standard output is a pipe, and sends that process `signal` as
/// soon as the command has written something. Returns the status of that process: the exit code that the child's end
/// gives, or 100.
int status_after(int signal, const std::string& script) {
  std::array<int, 2> pipe_ends{};
  EXPECT_EQ(pipe(pipe_ends.data()), 0);
  const pid_t parent = fork();
  if (parent == 0) {
    std::signal(signal, SIG_DFL);  // nohup ignores SIGHUP
    dup2(pipe_ends[1], STDOUT_FILENO);
    const auto status = run_attached({"sh", "-c", script});
    _exit(!status ? 100 : WIFSIGNALED(*status) ? 50 + WTERMSIG(*status) : WEXITSTATUS(*status));
  }
  char ready = 0;
  EXPECT_EQ(read(pipe_ends[0], &ready, 1), 1);
  kill(parent, signal);
  int status = 0;
  waitpid(parent, &status, 0);
  close(pipe_ends[0]), close(pipe_ends[1]);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST(ChildProcess, RequestsToEndArePassedOn) {
  for (const int signal : {SIGTERM, SIGHUP}) EXPECT_EQ(status_after(signal, "echo; exec sleep 60"), 50 + signal);
  EXPECT_EQ(status_after(SIGTERM, "trap 'exit 7' TERM; echo; while :; do sleep 0.05; done"), 7);
}

TEST(ChildProcess, ThisProcessTakesSignalsAgainAfterwards) {
  constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
  const auto handler = [](int signal) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    return now.sa_handler;
  };
  const std::array before{handler(SIGINT), handler(SIGTERM), handler(SIGHUP)};
  EXPECT_EQ(run_attached({"true"}), 0);
  for (size_t i = 0; i < kSignals.size(); ++i) EXPECT_EQ(handler(kSignals[i]), before[i]);
  sigset_t blocked;
  pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
  EXPECT_FALSE(sigismember(&blocked, SIGTERM));
}

TEST(ChildProcess, AMissingProgramIsNoError) {
  EXPECT_FALSE(run_attached({"/nonexistent/program"}));
  EXPECT_FALSE(run_dependent({"/nonexistent/program"}));
}

TEST(ChildProcess, ADependentOneReturnsWhatItPrints) {
  const auto result = run_dependent({"sh", "-c", "echo out; echo err >&2; exit 3"});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->out, "out\n");
  EXPECT_EQ(result->err, "err\n");
  EXPECT_EQ(WEXITSTATUS(result->status), 3);
}

TEST(ChildProcess, ADependentOneIsKilledByAStop) {
  std::stop_source stop;
  const StopScope scope(stop.get_token());
  const std::jthread later([&stop] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stop.request_stop();
  });
  EXPECT_THROW(run_dependent({"sleep", "600"}), Stopped);
}

/// The child reads its standard input, as frond's reader of models does, until the pipe ends.
TEST(ChildProcess, ADependentOneSeesThatThisProcessWasKilled) {
  std::array<int, 2> pipe_ends{};
  ASSERT_EQ(pipe(pipe_ends.data()), 0);
  const std::string to = std::to_string(pipe_ends[1]);
  const pid_t parent = fork();
  if (parent == 0) {
    run_dependent({"sh", "-c", "echo a >&" + to + "; cat; echo b >&" + to});
    _exit(0);
  }
  char said = 0;
  EXPECT_EQ(read(pipe_ends[0], &said, 1), 1);
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  close(pipe_ends[1]);
  std::string rest;
  while (read(pipe_ends[0], &said, 1) == 1) rest += said;
  EXPECT_EQ(rest, "\nb\n");
  close(pipe_ends[0]);
}

}  // namespace
}  // namespace frond
