#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "render/parts/identity.h"

namespace frond {

/// Writes what a measurement has summed up so far, as it is in memory, and of which measurement it is; whole or not at
/// all. Throws InputError with the system's reason.
void write_sums(const std::filesystem::path& path, const Identity& identity,
                const std::vector<std::span<const std::byte>>& arrays);

/// Reads it into arrays of the same sizes. Throws InputError, and leaves them alone, where it is of another
/// measurement, cut short, damaged or something else.
void read_sums(const std::filesystem::path& path, const Identity& identity,
               const std::vector<std::span<std::byte>>& arrays);

}  // namespace frond
