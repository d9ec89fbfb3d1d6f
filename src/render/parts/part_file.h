#pragma once

#include "render/parts/part.h"

namespace frond {

/// Writes a part, whole or not at all (docs/part_format.md). May be called while threads add to its film: then it has
/// some of their work items, each of them whole. Throws InputError with the system's reason.
void write_part(const std::filesystem::path& path, const PartHeader& header, const Film& film);

/// The same in memory.
std::vector<unsigned char> encode_part(const PartHeader& header, const Film& film);
/// `path` is what errors call it.
RenderPart decode_part(std::string_view bytes, const std::filesystem::path& path);

/// What a part's file says before its sums.
struct PartHead {
  PartHeader header;
  FilmFormat film;
};

/// Nothing of the sums is looked at. Throws as read_part does.
PartHead read_part_head(const std::filesystem::path& path);

/// Throws InputError for what is no part, cut short or damaged, and of another version of the format.
RenderPart read_part(const std::filesystem::path& path);

}  // namespace frond
