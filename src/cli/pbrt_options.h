#pragma once

#include <string>
#include <vector>

#include "jobs/record/pbrt_options.h"

namespace frond {

/// Returns the text of --help-pbrt: one line for each option of pbrt-v4 without a function in frond.
std::string pbrt_options_text();
/// Returns warnings for the given options that are ignored. Throws InputError for an option that is refused; the
/// message names frond's equivalent.
std::vector<std::string> pbrt_warnings(const std::vector<const PbrtOption*>& given);

/// Returns the command line in frond's spelling: `frond SCENE.pbrt` with options of pbrt-v4 (`-spp`, `--NThreads`)
/// becomes `frond render`. A word after --ignore-unsupported becomes its value if it is a list of kinds. `names` are
/// the long options of render.
std::vector<std::string> translate_pbrt_options(std::vector<std::string> words, const std::vector<std::string>& names);

/// Whether the word is a scene file's name: *.pbrt, *.pbrt.gz, or - for standard input.
bool is_scene_name(const std::string& word);

}  // namespace frond
