#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
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

/// Read-only memory map of a file: the system reads a page at its first access and may drop it if memory is short. The
/// file must not be truncated while it is mapped.
class MappedFile {
 public:
  /// Throws InputError as read_file_bytes.
  MappedFile(const std::filesystem::path& path, const Location& where, std::string_view what = {});
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// The file's content; valid as long as this object.
  std::span<const std::byte> bytes() const { return {data_, size_}; }

 private:
  const std::byte* data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace frond
