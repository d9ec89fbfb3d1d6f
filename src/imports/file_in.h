#pragma once

#include <filesystem>
#include <string>

namespace frond {

/// Returns the canonical path of a regular file that a model names, relative to `folder`; separators of Windows are
/// accepted, and another case of the file's letters if only one file has it. Throws std::runtime_error with the reason
/// if there is none, or if it is not in the folder or below it, which symbolic links do not change.
std::filesystem::path file_in(const std::filesystem::path& folder, std::string name);

}  // namespace frond
