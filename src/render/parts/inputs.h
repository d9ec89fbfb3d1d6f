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

/// Returns "; plug-ins are loaded from NAME...", or "" if there are none.
std::string loaded_from(std::span<const std::string> plugins);

/// Rethrows the current exception. If frond's own code does not throw such exceptions and shared objects are loaded, it
/// becomes an InputError that names them.
[[noreturn]] void rethrow_naming_plugins(std::span<const std::string> plugins);

/// Hash of frond's own code: the library, and the shared object for image files.
uint64_t hash_program(uint64_t seed);

/// Hash of a file's bytes, combined with `seed`. Throws InputError if the file cannot be read.
uint64_t hash_file(const std::filesystem::path& path, uint64_t seed);

}  // namespace frond
