#pragma once

#include "render/parts/part.h"

namespace frond {

/// Writes a part to a file (docs/many_machines.md), atomically. Threads may add to the film meanwhile: the file then
/// contains complete work items only. Throws InputError with the system's message.
void write_part(const std::filesystem::path& path, const PartHeader& header, const Film& film);

/// Returns the contents of a part file, in memory.
std::vector<unsigned char> encode_part(const PartHeader& header, const Film& film);
/// Reads the contents of a part file from memory; error messages name it `path`. Throws as read_part does.
RenderPart decode_part(std::string_view bytes, const std::filesystem::path& path);

/// Beginning of a part file, before the sums.
struct PartHead {
  PartHeader header;
  FilmFormat film;
};

/// Reads the header without the sums. Throws as read_part does.
PartHead read_part_head(const std::filesystem::path& path);

/// Reads a part. Throws InputError if the file is not a part, truncated, damaged, or of another version of the format.
RenderPart read_part(const std::filesystem::path& path);

}  // namespace frond
