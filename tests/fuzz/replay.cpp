// Replays a corpus without libFuzzer: fuzz_replay CORPUS [TARGET...]. CORPUS holds a folder of inputs for each target.
// Prints the number of inputs by target; the exit code is 1 if a target fails.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <vector>

#include "system/file_bytes.h"
#include "tests/fuzz/fuzz.h"

namespace {

namespace fs = std::filesystem;
using namespace frond;

std::string current_input;  // named if a signal ends the program

void name_input(int signal) {
  constexpr std::string_view kText = "\na signal ended the program at input ";
  (void)!::write(STDERR_FILENO, kText.data(), kText.size());
  (void)!::write(STDERR_FILENO, current_input.data(), current_input.size());
  (void)!::write(STDERR_FILENO, "\n", 1);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::vector<fs::path> inputs_in(const fs::path& corpus) {
  std::vector<fs::path> inputs;
  for (const auto& entry : fs::recursive_directory_iterator(corpus))
    if (entry.is_regular_file()) inputs.push_back(entry.path());
  std::sort(inputs.begin(), inputs.end());
  return inputs;
}

/// Returns the number of failures.
int replay(std::string_view name, fuzz::Target target, const std::vector<fs::path>& inputs) {
  int failures = 0;
  const auto start = std::chrono::steady_clock::now();
  for (const fs::path& input : inputs) {
    current_input = input.string();
    try {
      target(read_file_bytes(input, {}));
    } catch (const std::exception& error) {
      fmt::print(stderr, "{}: {}\n", input.string(), error.what());
      ++failures;
    }
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  fmt::print("{:20} {:5} inputs {:6.2f} s\n", name, inputs.size(), seconds);
  return failures;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty()) {
    fmt::print(stderr, "usage: fuzz_replay CORPUS [TARGET...]\n");
    return 1;
  }
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(signal, name_input);
  const fs::path corpus = fs::absolute(words[0]);
  int failures = 0;
  for (const auto& [name, target] : fuzz::targets()) {
    if (words.size() > 1 && std::find(words.begin() + 1, words.end(), name) == words.end()) continue;
    const fs::path inputs = corpus / name;
    if (!fs::is_directory(inputs)) {
      fmt::print(stderr, "{} has no corpus\n", name);
      ++failures;
    } else {
      failures += replay(name, target, inputs_in(inputs));
    }
  }
  if (failures > 0) fmt::print(stderr, "{} failures\n", failures);
  return failures > 0 ? 1 : 0;
}
