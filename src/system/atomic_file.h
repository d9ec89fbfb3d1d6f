#pragma once

#include <filesystem>
#include <span>

namespace frond {

/// Throws InputError if replace_file could not write to `path`: the folder does not exist or is not writable, or the
/// path exists and is not a writable regular file. No file remains after the check.
void check_replaceable(const std::filesystem::path& path);

/// Creates a folder and those above it that are missing. Throws InputError with the system's reason.
void make_folders(const std::filesystem::path& folder);

/// Writes a file atomically: `bytes` are written to a temporary file in the same folder, without a name where the file
/// system has such, synchronised to the disk and renamed to `path`. Temporary files that killed processes have left in
/// the folder are deleted. A symbolic link is followed. Throws InputError with the system's reason; an existing file is
/// then unchanged.
void replace_file(const std::filesystem::path& path, std::span<const unsigned char> bytes);

/// Writes a file atomically in several steps, for content that does not fit into memory. The file appears at its path
/// when `finish` returns. All functions throw InputError with the system's reason.
class NewFile {
 public:
  /// Creates a temporary file in the folder of `path`. Messages name `shown`, by default `path`.
  explicit NewFile(const std::filesystem::path& path, const std::filesystem::path& shown = {});
  /// Deletes the temporary file unless `finish` has been called.
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Appends the bytes.
  void write(std::span<const unsigned char> bytes);
  /// Synchronises the file to the disk and renames it. No other function may be called afterwards.
  void finish();

 private:
  std::filesystem::path target_, shown_, path_;
  int descriptor_ = -1;
};

}  // namespace frond
