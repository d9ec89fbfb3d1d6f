#include "system/file_identity.h"

namespace frond {

namespace fs = std::filesystem;

/// An absolute path first: weakly_canonical leaves a relative path of which nothing exists as it is.
bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::exists(a, error) || fs::exists(b, error)) return fs::equivalent(a, b, error) && !error;
  const auto full = [&error](const fs::path& path) { return fs::weakly_canonical(fs::absolute(path, error), error); };
  return full(a) == full(b) && !error;
}

}  // namespace frond
