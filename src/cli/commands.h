#pragma once

namespace frond {

/// Runs the frond command. Returns the program's exit code: 0 success; 1 wrong usage or input, with a message on
/// standard error; 2 `conform` found a broken law; 75 another frond process has locked the same part; 130 and 143
/// stopped by SIGINT or SIGTERM, with the partial result saved.
int run(int argc, const char* const* argv);

}  // namespace frond
