#pragma once

#include <string>

namespace frond {

/// Returns the text with "?" for control characters other than line ends and tabs: words of the input could clear a
/// terminal or hide a message, and a zero byte would cut it short.
std::string printable(std::string text);

}  // namespace frond
