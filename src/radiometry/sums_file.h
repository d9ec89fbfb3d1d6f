#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "render/parts/identity.h"

namespace frond {

/// Writes the accumulators of a measurement and its identity; the file is replaced only when complete. Throws
/// InputError with the system's reason.
void write_sums(const std::filesystem::path& path, const Identity& identity,
                const std::vector<std::span<const std::byte>>& arrays);

/// Reads accumulators into arrays of the same sizes. Throws InputError, and leaves the arrays unchanged, for a file of
/// another measurement, or a truncated or damaged file.
void read_sums(const std::filesystem::path& path, const Identity& identity,
               const std::vector<std::span<std::byte>>& arrays);

}  // namespace frond
