#pragma once

#include <map>
#include <string>
#include <string_view>

#include "core/build_record.h"

namespace frond {

/// Headers that this library was compiled from, as a path to a hash of it (made by cmake/FrondHeaders.cmake).
const std::map<std::string_view, std::string_view>& own_headers();

/// Why a shared object that left this record cannot go with this library, in words that follow its name; empty where it
/// can.
std::string mismatch(const BuildRecord& record);

}  // namespace frond
