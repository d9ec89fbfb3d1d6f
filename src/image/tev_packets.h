#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"

namespace frond {

// Packets of the protocol by which the viewer tev is shown images over TCP (github.com/Tom94/tev, include/tev/Ipc.h):
// length of all, type, body; numbers little endian, strings ended by a zero.

/// Where tev listens if nothing else is said.
inline constexpr const char* kTevAddress = "127.0.0.1:14158";

/// An image of this size with these channels, black, which the viewer goes to. One of the same name is replaced.
std::vector<unsigned char> create_image_packet(std::string_view name, const Image& image);

/// Its rows from `begin` to before `end`, all channels (UpdateImage, version 3). Throws InputError where they need 4
/// GiB or more.
std::vector<unsigned char> update_image_packet(std::string_view name, const Image& image, int begin, int end);

}  // namespace frond
