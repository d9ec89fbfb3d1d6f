#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/error.h"

namespace frond {

/// The whole of a file. Throws InputError at `where` when it cannot be read; folders and devices, which may never end,
/// are refused. The message calls the file `what`, or nothing but its name.
std::string read_file_bytes(const std::filesystem::path& path, const Location& where, std::string_view what = {});
/// The whole of standard input.
std::string read_standard_input();

/// A file's bytes, mapped into memory: read when they are looked at, and dropped where memory is short. The file must
/// not be cut short meanwhile.
class MappedFile {
 public:
  /// Throws InputError as read_file_bytes.
  MappedFile(const std::filesystem::path& path, const Location& where, std::string_view what = {});
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::span<const std::byte> bytes() const { return {data_, size_}; }

 private:
  const std::byte* data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace frond
