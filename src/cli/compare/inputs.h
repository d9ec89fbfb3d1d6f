#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/description.h"

namespace frond::compare {

/// The files that the parameters of the scene and of its wavelength strategy name (meshes, images, spectra), as far as
/// they exist.
std::vector<std::filesystem::path> input_files(const SceneDescription& description, const ParsedPlugin& wavelengths);

/// This program and the plug-ins that it loads.
std::vector<std::filesystem::path> program_files(std::span<const std::string> plugins);

/// Over the bytes, going on from `seed`. Throws InputError when they cannot be read.
uint64_t hash_file(const std::filesystem::path& path, uint64_t seed);

}  // namespace frond::compare
