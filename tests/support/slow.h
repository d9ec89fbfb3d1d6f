#pragma once

#include <cstdlib>
#include <string_view>

namespace frond {

/// Whether tests that take minutes run too.
inline bool slow_tests() {
  const char* wish = std::getenv("FROND_SLOW_TESTS");
  return wish && std::string_view(wish) == "1";
}

}  // namespace frond
