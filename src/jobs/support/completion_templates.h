#pragma once

#include <string_view>

namespace frond {

// The files in src/jobs/completion, made part of the program by CMake.
extern const std::string_view bash_completion, zsh_completion, fish_completion;

}  // namespace frond
