#pragma once

#include <string>
#include <string_view>

#include "core/error.h"

namespace frond {

/// Whether these bytes begin as a gzip file does (RFC 1952).
bool is_gzip(std::string_view bytes);

/// What a gzip file of one or more members holds. Throws InputError at `where` where it is damaged or cut short, and
/// where it would fill more than `most` bytes. Messages call it `name`.
std::string unpack_gzip(std::string_view bytes, const std::string& name, const Location& where,
                        size_t most = size_t{1} << 36);

}  // namespace frond
