#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace frond {

/// Returns the number of bytes of the UTF-8 character that a text begins with; 0 if it begins with none: a byte of
/// another encoding, an overlong form, a surrogate, or the end.
inline size_t utf8_length(std::string_view text) {
  /// Characters of `length` bytes begin with a byte in [first, last] and are `least` or more.
  struct Kind {
    unsigned first, last;
    size_t length;
    uint32_t least;
  };
  constexpr Kind kKinds[] = {
      {0x00, 0x7f, 1, 0}, {0xc2, 0xdf, 2, 0x80}, {0xe0, 0xef, 3, 0x800}, {0xf0, 0xf4, 4, 0x10000}};
  if (text.empty()) return 0;
  const unsigned first = static_cast<unsigned char>(text[0]);
  const auto* kind = std::ranges::find_if(kKinds, [&](const Kind& k) { return k.first <= first && first <= k.last; });
  if (kind == std::end(kKinds) || text.size() < kind->length) return 0;
  uint32_t code = first - (kind->first & 0xf0);
  for (size_t k = 1; k < kind->length; ++k) {
    const unsigned next = static_cast<unsigned char>(text[k]);
    if ((next & 0xc0) != 0x80) return 0;
    code = code << 6 | (next & 0x3f);
  }
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  return code < kind->least || code > 0x10ffff || is_surrogate ? 0 : kind->length;
}

inline bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const size_t length = utf8_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

}  // namespace frond
