#pragma once

#include <ctime>

namespace frond {

/// What files that are written say of when they were: now, or SOURCE_DATE_EPOCH if that is set. Throws InputError where
/// that is no time.
std::time_t file_time();

}  // namespace frond
