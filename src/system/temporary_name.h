#pragma once

#include <filesystem>
#include <string>

/// Names of files and folders that are being written, for NewFile and NewFiles. A process locks its own, so that files
/// of killed processes can be recognised and deleted.
namespace frond {

/// Returns the target of a symbolic link, else the path: renaming a file to a link would replace the link.
std::filesystem::path follow_links(const std::filesystem::path& path);

/// Returns the folder of a file; "." without one.
std::filesystem::path folder_of(const std::filesystem::path& path);

/// Returns the next temporary name of this process. No name is returned twice, since remove_leftover_files of another
/// process may still hold a file that had it.
std::string temporary_name();

/// Deletes the leftovers of killed processes in a folder: files and folders with temporary names whose lock can be
/// taken. Does so once for each folder.
void remove_leftover_files(const std::filesystem::path& folder);

/// Locks a new file or folder, open as `descriptor`, against remove_leftover_files. Returns false if it has been
/// deleted already. Without locks in a file system nothing is removed there.
bool lock_new(int descriptor, const std::filesystem::path& path);

}  // namespace frond
