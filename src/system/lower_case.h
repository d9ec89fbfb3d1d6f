#pragma once

#include <string>
#include <string_view>

namespace frond {

/// Returns the text in lower case (ASCII).
inline std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return result;
}

}  // namespace frond
