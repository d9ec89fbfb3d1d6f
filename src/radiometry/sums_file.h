#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "render/parts/identity.h"

namespace frond {

/// Sums of a measurement over a range of its paths. Parts of equal identities, of ranges that follow each other, add up
/// to the same bits as one measurement.
struct SumsPart {
  Identity identity;
  uint64_t begin = 0, end = 0;      ///< numbers of the paths; `end` is excluded
  std::vector<std::string> arrays;  ///< bytes of the accumulators
};

/// Writes the parts of one or more measurements, as of the times of a day; the file is replaced only when complete.
/// Throws InputError with the system's reason.
void write_sums(const std::filesystem::path& path, std::span<const SumsPart> parts);

/// Returns the parts of a file. Throws InputError for a file of another kind, or a truncated or damaged file.
std::vector<SumsPart> read_sums(const std::filesystem::path& path);

}  // namespace frond
