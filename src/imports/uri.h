#pragma once

#include <string>
#include <string_view>

namespace frond {

/// Returns a relative URI of glTF as the name of a file: %20 is a blank. Text that is no percent-encoding, or encodes a
/// zero byte, is returned unchanged.
std::string percent_decoded(std::string_view uri);

}  // namespace frond
