#pragma once

#include <string>
#include <vector>

#include "jobs/record/pbrt_options.h"

namespace frond {

/// A line for each option of pbrt-v4 that frond has no use for: what --help-pbrt prints.
std::string pbrt_options_text();
/// Warnings about those of them that have no effect. Throws InputError for one that is refused, with what frond has
/// instead.
std::vector<std::string> pbrt_warnings(const std::vector<const PbrtOption*>& given);

/// The command line in frond's spelling: `frond SCENE.pbrt` with options of pbrt-v4 (`-spp`, `--NThreads`) becomes
/// `frond render`; a word after --ignore-unsupported belongs to it if it lists kinds. `names`: the long options of
/// render.
std::vector<std::string> with_pbrt_spelling(std::vector<std::string> words, const std::vector<std::string>& names);

/// Whether a word is called as scene files are.
bool is_scene_name(const std::string& word);

}  // namespace frond
