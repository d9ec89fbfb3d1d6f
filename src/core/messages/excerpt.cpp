#include "core/messages/excerpt.h"

#include <algorithm>
#include <mutex>
#include <set>

namespace frond {
namespace {

namespace fs = std::filesystem;

constexpr size_t kLongest = 40, kLongestForeign = 8;

/// Returns the first `most` bytes, without a part of a UTF-8 character at the end.
std::string_view valid_prefix(std::string_view text, size_t most) {
  const auto continues = [&text](size_t i) { return (static_cast<unsigned char>(text[i]) & 0xc0) == 0x80; };
  for (size_t back = 0; back < 3 && most > 0 && continues(most); ++back) --most;
  return text.substr(0, most);
}

/// The real path, or the path itself where it has none.
std::string real_name(const fs::path& file) {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(file, error);
  return (error ? file : real).string();
}

/// Real paths of foreign files, for the whole process: a reader knows its file, not the scene that names it.
struct ForeignFiles {
  std::mutex mutex;
  std::set<std::string, std::less<>> names;
};

ForeignFiles& foreign_files() {
  static ForeignFiles files;
  return files;
}

/// Appends a character, or its escape.
void append_escaped(std::string& to, char c) {
  const auto code = static_cast<unsigned char>(c);
  if (c == '\n')
    to += "\\n";
  else if (c == '\r')
    to += "\\r";
  else if (c == '\t')
    to += "\\t";
  else if (code < 0x20 || code == 0x7f)
    to += fmt::format("\\x{:02x}", code);
  else
    to += c;
}

std::string truncated(std::string_view word, size_t most) {
  return word.size() <= most ? std::string(word) : fmt::format("{}...", valid_prefix(word, most));
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) append_escaped(result, c);
  return result;
}

std::string printable(std::string_view text) {
  std::string result;
  for (const char c : text)
    if (c == '\n' || c == '\t')
      result += c;
    else
      append_escaped(result, c);
  return result;
}

std::string excerpt(std::string_view word, const fs::path& file) {
  return truncated(word, is_foreign(file) ? kLongestForeign : kLongest);
}

std::string excerpt(std::string_view word, const Location& where) {
  return where.file ? excerpt(word, fs::path(*where.file)) : truncated(word, kLongest);
}

std::string with_short_quotes(std::string_view message, const Location& where) {
  if (!where.file || !is_foreign(*where.file)) return std::string(message);
  std::string result;
  while (!message.empty()) {
    const size_t begin = std::min(message.find('"'), message.size());
    const size_t end = std::min(message.find('"', begin + 1), message.size());
    result += message.substr(0, begin);
    if (begin < message.size()) result += '"' + truncated(message.substr(begin + 1, end - begin - 1), kLongestForeign);
    if (end < message.size()) result += '"';
    message.remove_prefix(std::min(end + 1, message.size()));
  }
  return result;
}

void mark_foreign(const fs::path& file) {
  ForeignFiles& files = foreign_files();
  std::string name = real_name(file);
  const std::lock_guard lock(files.mutex);
  files.names.insert(std::move(name));
}

bool is_foreign(const fs::path& file) {
  ForeignFiles& files = foreign_files();
  {
    const std::lock_guard lock(files.mutex);
    if (files.names.empty()) return false;
  }
  const std::string name = real_name(file);
  const std::lock_guard lock(files.mutex);
  return files.names.contains(name);
}

}  // namespace frond
