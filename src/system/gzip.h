#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "core/error.h"

namespace frond {

/// Returns whether the bytes begin with the magic number of gzip (RFC 1952).
bool is_gzip(std::string_view bytes);

/// Largest size in bytes that `packed` bytes of compressed text may unpack to. Scenes and meshes are compressed to
/// about a tenth; a file made to exhaust memory, to a thousandth.
constexpr size_t most_unpacked(size_t packed) { return std::max(size_t{1} << 25, 64 * packed); }

/// Returns the uncompressed content of a gzip file of one or more members. Throws InputError at `where` if the file is
/// damaged or truncated, or unpacks to more than `most` bytes (0: most_unpacked). `name` is the file in messages.
std::string unpack_gzip(std::string_view bytes, const std::string& name, const Location& where, size_t most = 0);

/// Returns what the first bytes of a gzip file unpack to, up to 256 KiB; "" if they are damaged.
std::string unpack_gzip_start(std::string_view bytes);

}  // namespace frond
