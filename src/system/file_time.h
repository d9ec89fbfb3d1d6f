#pragma once

#include <ctime>

namespace frond {

/// Returns the time that is stored in written files: the present, or the environment variable SOURCE_DATE_EPOCH
/// (seconds since 1970) for reproducible files. Throws InputError if the variable's value is not a time.
std::time_t file_time();

}  // namespace frond
