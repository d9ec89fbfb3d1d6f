#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace frond {

/// Result of a program that has ended.
struct ChildResult {
  int status = 0;        ///< as from waitpid; 0: success
  std::string out, err;  ///< standard output and standard error
};

/// Runs a program, which is searched for in PATH, with `input` as its standard input, and waits until it ends. Returns
/// nothing if there is no such program. Throws InputError if it cannot be run for any other reason.
std::optional<ChildResult> run_child(const std::vector<std::string>& command, const std::string& input);

/// Runs one of frond's programs until it ends or this process ends, by any signal: the program's standard input is a
/// pipe that nobody writes to, and the program must exit when the pipe is closed. If a stop is requested meanwhile,
/// kills the program and throws Stopped. Returns nothing if there is no such program. Throws InputError if it cannot be
/// run for any other reason.
std::optional<ChildResult> run_dependent(const std::vector<std::string>& command);

/// Runs a program, which is searched for in PATH, on this process's standard streams, and waits until it ends. As in
/// system(3), SIGINT from the terminal ends the program and not this process; SIGTERM and SIGHUP are passed on to it.
/// With `output`, what the program prints goes to this file, which is replaced. Returns the status as from waitpid, or
/// nothing if there is no such program. Throws InputError if it cannot be run for any other reason, or if the file
/// cannot be written. Not for two threads at once.
std::optional<int> run_attached(const std::vector<std::string>& command, const std::filesystem::path& output = {});

/// Returns whether PATH has a program of this name.
bool is_in_path(const std::string& program);

/// Returns how a program ended, for an error message: "exit code 1", "signal 9".
std::string exit_text(int status);

}  // namespace frond
