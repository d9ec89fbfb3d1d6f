#pragma once

#include <filesystem>

namespace frond {

/// Whether both paths are of one file: the same device and inode, as hard and symbolic links are, or, of files that do
/// not exist, the same name in the same folder.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace frond
