#include "leaf/cache_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "core/random.h"

namespace frond::leaf {
namespace {

constexpr std::string_view kChecksum = "# checksum ";

std::string checksum_line(std::string_view text) { return fmt::format("{}{:016x}\n", kChecksum, hash_bytes(text)); }

}  // namespace

std::string with_checksum(std::string text) { return text + checksum_line(text); }

std::string_view without_checksum(std::string_view text) {
  const size_t body = text.rfind(kChecksum);
  if (body == std::string_view::npos || text.substr(body) != checksum_line(text.substr(0, body))) return {};
  return text.substr(0, body);
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool write_file(const std::filesystem::path& path, const std::string& text) {
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  const auto temporary = std::filesystem::path(path) += fmt::format(".{}.tmp", getpid());
  {
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    out.close();
    if (!out) {
      std::filesystem::remove(temporary, error);
      return false;
    }
  }
  std::filesystem::rename(temporary, path, error);
  if (!error) return true;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  return false;
}

}  // namespace frond::leaf
