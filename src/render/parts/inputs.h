#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/format/description.h"

namespace frond {

/// Existing files that parameters of the scene and of its wavelength strategy name: meshes, images, spectra.
std::vector<std::filesystem::path> input_files(const SceneDescription& scene, const ParsedPlugin& wavelengths);

/// Shared objects that load_registry loads.
std::vector<std::filesystem::path> plugin_files(std::span<const std::string> plugins);

/// Hash of frond's own code: the library, and the shared object for image files.
uint64_t hash_program(uint64_t seed);

/// Like hash_file, for a shared object that is loaded. It reads the file instead of mapping it: a second mapping
/// confuses perf, which records mappings but not their end and then cannot resolve stacks through the library.
uint64_t hash_library(const std::filesystem::path& path, uint64_t seed);

/// Hash of a file's bytes, combined with `seed`. Throws InputError if the file cannot be read.
uint64_t hash_file(const std::filesystem::path& path, uint64_t seed);

}  // namespace frond
