#pragma once

#include <string>
#include <string_view>

namespace frond {

/// Escapes the characters that XML reserves; control characters, which XML does not have, become blanks.
std::string xml_escaped(std::string_view text);

/// Returns a line with a comment, which two hyphens would end.
std::string xml_comment(std::string_view text);

}  // namespace frond
