#include "scene/file_bytes.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace frond {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// Devices would never end, and folders open but do not read.
void check_kind(const fs::path& path, const Location& where) {
  std::error_code error;
  const fs::file_type type = fs::status(path, error).type();
  if (type == fs::file_type::not_found) fail(where, "there is no file {}", path.string());
  if (type == fs::file_type::directory) fail(where, "{} is a folder, not a file", path.string());
  if (type != fs::file_type::regular && type != fs::file_type::fifo)
    fail(where, "{} is not a regular file", path.string());
}

File open(const fs::path& path, const Location& where) {
  check_kind(path, where);
  File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(where, "cannot open {}: {}", path.string(), std::strerror(errno));
  return file;
}

void append_rest(std::FILE* file, const fs::path& path, const Location& where, std::string& bytes) {
  std::array<char, 1 << 16> block;
  while (const size_t count = std::fread(block.data(), 1, block.size(), file)) bytes.append(block.data(), count);
  if (std::ferror(file)) fail(where, "cannot read {}: {}", path.string(), std::strerror(errno));
}

}  // namespace

std::string read_file_bytes(const fs::path& path, const Location& where) {
  const File file = open(path, where);
  std::string bytes;
  std::error_code unknown_size;
  if (const auto size = fs::file_size(path, unknown_size); !unknown_size) bytes.reserve(size);
  append_rest(file.get(), path, where, bytes);
  return bytes;
}

std::string read_standard_input() {
  std::string bytes;
  append_rest(stdin, "standard input", {}, bytes);
  return bytes;
}

}  // namespace frond
