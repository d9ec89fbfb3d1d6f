#include "system/file_range.h"

#include <cstdio>
#include <memory>

namespace frond {

std::string read_file_range(const std::filesystem::path& path, uint64_t begin, size_t size) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file || std::fseek(file.get(), long(begin), SEEK_SET) != 0) return {};
  std::string bytes(size, '\0');
  bytes.resize(std::fread(bytes.data(), 1, size, file.get()));
  return bytes;
}

}  // namespace frond
