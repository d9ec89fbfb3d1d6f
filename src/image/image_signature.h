#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"

namespace frond {

/// Returns OpenImageIO's name of the format of an image file ("openexr", "png", "jpeg", "hdr", "tiff", "pnm" for PFM,
/// "bmp", "webp", "targa"). The first bytes decide, so that a misleading name never selects a reader; TGA, which has no
/// signature, needs the extension .tga and a valid header. Throws InputError at `where` for all other content; the
/// message names the format if it is a known one.
std::string_view image_format_of(std::string_view bytes, const std::filesystem::path& path, const Location& where);

}  // namespace frond
