#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"

namespace frond {

/// The whole of a file. Throws InputError at `where` when it cannot be read.
std::string read_file_bytes(const std::filesystem::path& path, const Location& where);
/// The whole of standard input.
std::string read_standard_input();

}  // namespace frond
