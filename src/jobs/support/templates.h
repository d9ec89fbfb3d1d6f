#pragma once

#include <string_view>

namespace frond {

// Text files that CMake embeds into the library.

/// Contents of src/jobs/completion.
extern const std::string_view bash_completion, zsh_completion, fish_completion;
/// Contents of src/jobs/submit: of slurm, openjd and snakemake. `frond submit` replaces @NAMES@ in them.
extern const std::string_view render_sbatch, merge_sbatch, submit_sh, openjd_template, snakefile;

}  // namespace frond
