#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace frond {

/// Returns the whole content of a regular file or named pipe. Throws InputError at `where` if it cannot be read, and
/// for folders and devices, which may be endless. `what` describes the file in the message, for example "spectrum
/// file".
std::string read_file_bytes(const std::filesystem::path& path, const Location& where, std::string_view what = {});
/// Returns the whole of standard input. Throws InputError if it cannot be read.
std::string read_standard_input();

/// Calls `use` with consecutive blocks of a file, all but the last of 1 MiB, for files that need not be in memory
/// whole. Returns the number of bytes. Throws InputError as read_file_bytes.
uint64_t read_file_blocks(const std::filesystem::path& path, const Location& where,
                          const std::function<void(std::string_view)>& use);

}  // namespace frond
