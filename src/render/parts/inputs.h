#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/format/description.h"

namespace frond {

/// The files that the parameters of the scene and of its wavelength strategy name (meshes, images, spectra), as far as
/// they exist.
std::vector<std::filesystem::path> input_files(const SceneDescription& scene, const ParsedPlugin& wavelengths);

/// The plug-ins that load_registry loads.
std::vector<std::filesystem::path> plugin_files(std::span<const std::string> plugins);

/// Over the files that hold frond's own code: the library, and what it opens for image files.
uint64_t hash_program(uint64_t seed);

/// As hash_file, of code that is loaded: read, not mapped once more, for perf learns of mappings and not of their end,
/// and then finds no stack that goes through it.
uint64_t hash_library(const std::filesystem::path& path, uint64_t seed);

/// Over the bytes, going on from `seed`. Throws InputError when they cannot be read.
uint64_t hash_file(const std::filesystem::path& path, uint64_t seed);

}  // namespace frond
