#include "image/tev_packets.h"

#include <gtest/gtest.h>

namespace frond {
namespace {

using Bytes = std::vector<unsigned char>;

// Written out by hand from tev's Ipc.h.
TEST(TevPackets, AreTheProtocolsByteByByte) {
  Image image(2, 3, {"R", "G"});
  for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(i);
  EXPECT_EQ(create_image_packet("a.exr", image), (Bytes{28,  0,   0,   0,            // length
                                                        4,                           // CreateImage
                                                        1,                           // to be looked at
                                                        'a', '.', 'e', 'x', 'r', 0,  // name
                                                        2,   0,   0,   0,   3,   0, 0, 0, 2, 0, 0, 0,  // size, channels
                                                        'R', 0,   'G', 0}));
  const Bytes update = update_image_packet("a", image, 1, 2);
  EXPECT_EQ(update, (Bytes{80,  0, 0,    0,                                                 // length
                           6,                                                               // UpdateImage, version 3
                           0,                                                               // goes on in the background
                           'a', 0,                                                          // name
                           2,   0, 0,    0,    'R', 0, 'G',  0,                             // channels
                           0,   0, 0,    0,    1,   0, 0,    0,    2, 0, 0, 0, 1, 0, 0, 0,  // x, y, width, height
                           0,   0, 0,    0,    0,   0, 0,    0,    1, 0, 0, 0, 0, 0, 0, 0,  // where channels begin
                           2,   0, 0,    0,    0,   0, 0,    0,    2, 0, 0, 0, 0, 0, 0, 0,  // from value to value
                           0,   0, 0x80, 0x40, 0,   0, 0xa0, 0x40,                          // 4, 5
                           0,   0, 0xc0, 0x40, 0,   0, 0xe0, 0x40}));                       // 6, 7
}

}  // namespace
}  // namespace frond
