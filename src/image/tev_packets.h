#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"

namespace frond {

// Packets of the TCP protocol of the image viewer tev (github.com/Tom94/tev, include/tev/Ipc.h): length of the packet
// in bytes, type, body. Numbers are little-endian, strings zero-terminated.

/// Default address of tev.
inline constexpr const char* kTevAddress = "127.0.0.1:14158";

/// Returns a packet that creates a black image with the size and channels of `image` and selects it in the viewer. It
/// replaces an image of the same name.
std::vector<unsigned char> create_image_packet(std::string_view name, const Image& image);

/// Returns a packet (UpdateImage, version 3) with all channels of the rows [begin, end) of `image`. Throws InputError
/// if it needs 4 GiB or more.
std::vector<unsigned char> update_image_packet(std::string_view name, const Image& image, int begin, int end);

}  // namespace frond
