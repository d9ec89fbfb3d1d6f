#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace frond {

/// Adds the options of pbrt-v4 that frond has no use for: they are accepted with a warning, or refused with what frond
/// has instead. They are not in --help, but in --help-pbrt and the man page.
void add_pbrt_options(CLI::App& render);

/// A line for each of those options: what --help-pbrt prints.
std::string pbrt_options_text();
/// Of the options of pbrt-v4 in the words of `frond render`, warnings about those that have no effect. Throws
/// InputError for one that is refused.
std::vector<std::string> pbrt_warnings(const CLI::App& render);

/// The command line in frond's spelling: `frond SCENE.pbrt` with options of pbrt-v4 (`-spp`, `--NThreads`) becomes
/// `frond render`; a word after --ignore-unsupported belongs to it if it lists kinds.
std::vector<std::string> with_pbrt_spelling(std::vector<std::string> words, const CLI::App& render);

/// Whether a word is called as scene files are.
bool is_scene_name(const std::string& word);

}  // namespace frond
