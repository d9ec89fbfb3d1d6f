#pragma once

#include <filesystem>
#include <string>

#include "core/error.h"

namespace frond {

/// The whole of a file or, for "-", of standard input. Throws InputError at `where` when it cannot be read.
std::string read_file_bytes(const std::filesystem::path& path, const Location& where);

}  // namespace frond
