#pragma once

namespace frond {

/// Runs the frond command. Returns the program's exit code: 0 done; 1 bad use or bad input, with a message on standard
/// error; 2 `conform` found a law broken; 75 another frond works on the same part; 130 and 143 stopped by SIGINT or
/// SIGTERM, with the partial result kept.
int run(int argc, const char* const* argv);

}  // namespace frond
