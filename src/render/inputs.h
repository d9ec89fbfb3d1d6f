#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/description.h"

namespace frond {

/// The files that the parameters of the scene and of its wavelength strategy name (meshes, images, spectra), as far as
/// they exist.
std::vector<std::filesystem::path> input_files(const SceneDescription& scene, const ParsedPlugin& wavelengths);

/// The plug-ins that load_registry loads.
std::vector<std::filesystem::path> plugin_files(std::span<const std::string> plugins);

/// The file that holds frond's own code: the library, or the program that it is linked into.
std::filesystem::path program_file();

/// Over the bytes, going on from `seed`. Throws InputError when they cannot be read.
uint64_t hash_file(const std::filesystem::path& path, uint64_t seed);

}  // namespace frond
