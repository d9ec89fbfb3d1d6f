#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"

namespace frond {

/// The whole of a file. Throws InputError at `where` when it cannot be read; folders and devices, which may never end,
/// are refused. The message calls the file `what`, or nothing but its name.
std::string read_file_bytes(const std::filesystem::path& path, const Location& where, std::string_view what = {});
/// The whole of standard input.
std::string read_standard_input();

}  // namespace frond
