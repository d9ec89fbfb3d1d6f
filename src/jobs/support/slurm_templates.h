#pragma once

#include <string_view>

namespace frond {

// The files in src/jobs/slurm, made part of the program by CMake. @NAMES@ in them are filled in by frond submit.
extern const std::string_view render_sbatch, merge_sbatch, submit_sh;

}  // namespace frond
