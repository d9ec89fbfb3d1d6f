#include "system/file_bytes.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "core/messages/excerpt.h"
#include "core/parallel.h"
#include "system/file_uses.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// File to read, and its description in messages.
struct NamedFile {
  std::string path;
  const Location& where;
  std::string_view what;

  /// The path in a message without quotation marks.
  std::string shown() const { return where.file && is_foreign(*where.file) ? excerpt(path, where) : path; }
  /// Throws InputError. `plain` is the complete message for a file without a description.
  [[noreturn]] void reject(std::string_view reason, std::string_view plain) const {
    if (what.empty()) fail(where, "{}", plain);
    fail(where, "cannot read {} \"{}\": {}", what, path, reason);
  }
  [[noreturn]] void reject(std::string_view attempt, int error) const {
    const char* reason = std::strerror(error);
    reject(reason, fmt::format("cannot {} {}: {}", attempt, shown(), reason));
  }
};

/// Throws for devices, which may be endless, and for folders, which can be opened but not read.
void check_kind(const NamedFile& source) {
  std::error_code error;
  const fs::file_type type = fs::status(source.path, error).type();
  if (type == fs::file_type::not_found) source.reject(std::strerror(ENOENT), "there is no file " + source.shown());
  if (type == fs::file_type::none) source.reject("open", error.value());
  if (type == fs::file_type::directory) source.reject("it is a folder", source.shown() + " is a folder, not a file");
  if (type != fs::file_type::regular && type != fs::file_type::fifo)
    source.reject("it is no regular file", source.shown() + " is not a regular file");
}

File open_file(const NamedFile& source) {
  check_kind(source);
  File file(std::fopen(source.path.c_str(), "rb"));
  if (!file) source.reject("open", errno);
  record_read(source.path, source.where);
  return file;
}

void append_rest(std::FILE* file, const NamedFile& source, std::string& bytes) {
  std::array<char, 1 << 16> block;
  while (const size_t count = std::fread(block.data(), 1, block.size(), file)) {
    check_stop();
    bytes.append(block.data(), count);
  }
  if (std::ferror(file)) source.reject("read", errno);
}

}  // namespace

std::string read_file_bytes(const fs::path& path, const Location& where, std::string_view what) {
  const NamedFile source{path.string(), where, what};
  const File file = open_file(source);
  std::string bytes;
  std::error_code unknown_size;  // a pipe has none
  if (const auto size = fs::file_size(path, unknown_size); !unknown_size) bytes.reserve(size);
  append_rest(file.get(), source, bytes);
  return bytes;
}

std::string read_standard_input() {
  std::string bytes;
  append_rest(stdin, {"standard input", {}, {}}, bytes);
  return bytes;
}

uint64_t read_file_blocks(const fs::path& path, const Location& where,
                          const std::function<void(std::string_view)>& use) {
  constexpr size_t kBlock = 1 << 20;
  const NamedFile source{path.string(), where, {}};
  const File file = open_file(source);
  std::string block(kBlock, '\0');
  uint64_t all = 0;
  while (const size_t count = std::fread(block.data(), 1, kBlock, file.get())) {
    check_stop();
    use({block.data(), count});
    all += count;
  }
  if (std::ferror(file.get())) source.reject("read", errno);
  return all;
}

}  // namespace frond
