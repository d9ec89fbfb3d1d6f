#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace frond {

/// Returns up to `size` bytes of a regular file from `begin`; "" if there are none or they cannot be read.
std::string read_file_range(const std::filesystem::path& path, uint64_t begin, size_t size);

}  // namespace frond
