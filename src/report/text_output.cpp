#include "report/text_output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core/error.h"
#include "system/atomic_file.h"

namespace frond {
namespace {

bool is_standard_output(const std::string& path) { return path == "-"; }

}  // namespace

void check_text_output(const std::string& path) {
  if (!is_standard_output(path)) check_replaceable(path);
}

void write_text(const std::string& path, std::string_view text) {
  if (!is_standard_output(path))
    return replace_file(path, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    fail({}, "cannot write to standard output: {}", std::strerror(errno));
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

}  // namespace frond
