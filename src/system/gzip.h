#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "core/error.h"

namespace frond {

/// Whether these bytes begin as a gzip file does (RFC 1952).
bool is_gzip(std::string_view bytes);

/// What text of `packed` bytes may unpack to: scenes and meshes pack to a tenth or so, a file that is made to fill the
/// memory to a thousandth.
constexpr size_t most_unpacked(size_t packed) { return std::max(size_t{1} << 28, 64 * packed); }

/// What a gzip file of one or more members holds. Throws InputError at `where` where it is damaged or cut short, and
/// where it would fill more than `most` bytes; 0: most_unpacked. Messages call it `name`.
std::string unpack_gzip(std::string_view bytes, const std::string& name, const Location& where, size_t most = 0);

}  // namespace frond
