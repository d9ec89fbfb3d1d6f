#pragma once

#include <string_view>

namespace frond {

// Files that CMake makes part of the library.

/// Of src/jobs/completion.
extern const std::string_view bash_completion, zsh_completion, fish_completion;
/// Of src/jobs/slurm; `frond submit` fills in @NAMES@ in them.
extern const std::string_view render_sbatch, merge_sbatch, submit_sh;

}  // namespace frond
