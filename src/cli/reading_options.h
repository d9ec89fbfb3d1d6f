#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/unsupported.h"

namespace CLI {
class App;
}

namespace frond {

/// What commands are told of scene files.
struct ReadingOptions {
  std::string ignore_unsupported;  ///< empty: nothing
  bool strict = false;
};

/// What they let pass. Throws InputError.
Unsupported unsupported_of(const ReadingOptions& options);

/// `--ignore-unsupported[=KINDS]` and `--strict`.
void add_reading_options(CLI::App& command, ReadingOptions& options);

/// Scenes, each in the files that are read one after the other: a file without WorldBegin and the one after it are one.
std::vector<std::vector<std::filesystem::path>> scenes_of(const std::vector<std::string>& files);

/// The command line with pbrt's spelling put into ours: `frond SCENE.pbrt` is `render`, whose options then may be
/// written as pbrt takes them, `-spp` and `--NThreads` for two; and what follows --ignore-unsupported belongs to it
/// where it can.
std::vector<std::string> with_pbrt_spelling(std::vector<std::string> words, const CLI::App& render);

}  // namespace frond
