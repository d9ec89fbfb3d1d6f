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

/// The same for what is too large to be held in memory, piece by piece: the file is there when `finish` has returned.
class NewFile {
 public:
  explicit NewFile(const std::filesystem::path& path);
  /// Without `finish` nothing is left of it.
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void write(std::span<const unsigned char> bytes);
  void finish();

 private:
  std::filesystem::path target_, path_;
  int descriptor_ = -1;
};

}  // namespace frond
