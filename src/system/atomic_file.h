#pragma once

#include <filesystem>
#include <span>

namespace frond {

/// Refuses, by InputError, a path whose folder cannot take a new file, or which is something else than a regular file.
/// Leaves nothing behind.
void check_replaceable(const std::filesystem::path& path);

/// Puts `bytes` at `path`, whole or not at all: written under another name in the same folder, synchronised to the
/// disk, renamed. A symbolic link is followed. Throws InputError with the system's reason; the old file is then
/// untouched.
void replace_file(const std::filesystem::path& path, std::span<const unsigned char> bytes);

}  // namespace frond
