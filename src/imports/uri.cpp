#include "imports/uri.h"

#include <charconv>

namespace frond {

std::string percent_decoded(std::string_view uri) {
  std::string name;
  for (size_t i = 0; i < uri.size(); ++i) {
    unsigned code = 0;
    const char *digits = uri.data() + i + 1, *end = digits + 2;
    const bool is_encoded = uri[i] == '%' && i + 2 < uri.size() && std::from_chars(digits, end, code, 16).ptr == end;
    if (is_encoded && code != 0) {
      name += char(code);
      i += 2;
    } else {
      name += uri[i];
    }
  }
  return name;
}

}  // namespace frond
