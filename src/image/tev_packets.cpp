#include "image/tev_packets.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>

#include "core/error.h"

namespace frond {
namespace {

/// Types of packets that are sent, as numbered by tev.
enum class Type : uint8_t { create_image = 4, update_image = 6 };

/// Packet under construction.
class Packet {
 public:
  Packet(Type type, bool grabs_focus, std::string_view name) {
    put(uint32_t{0});  // the length, set by `take`
    put(uint8_t(type));
    put(uint8_t(grabs_focus));
    put(name);
  }

  template <class Integer>
  requires std::is_integral_v<Integer>
  void put(Integer value) {
    for (size_t byte = 0; byte < sizeof value; ++byte)
      bytes_.push_back(static_cast<unsigned char>(std::make_unsigned_t<Integer>(value) >> (8 * byte)));
  }
  void put(std::string_view text) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    bytes_.push_back(0);
  }
  void put_channels(const std::vector<std::string>& names) {
    put(int32_t(names.size()));
    for (const std::string& name : names) put(std::string_view(name));
  }
  void put(std::span<const float> values) {
    if constexpr (std::endian::native == std::endian::little) {
      const size_t at = bytes_.size();
      bytes_.resize(at + values.size_bytes());
      std::memcpy(bytes_.data() + at, values.data(), values.size_bytes());
    } else {
      for (const float v : values) put(std::bit_cast<uint32_t>(v));
    }
  }

  std::vector<unsigned char> take() {
    if (bytes_.size() > std::numeric_limits<uint32_t>::max())
      fail({}, "{} bytes of an image are too many for a packet", bytes_.size());
    for (size_t byte = 0; byte < 4; ++byte) bytes_[byte] = static_cast<unsigned char>(bytes_.size() >> (8 * byte));
    return std::move(bytes_);
  }

 private:
  std::vector<unsigned char> bytes_;
};

}  // namespace

std::vector<unsigned char> create_image_packet(std::string_view name, const Image& image) {
  Packet packet(Type::create_image, true, name);
  packet.put(int32_t(image.width));
  packet.put(int32_t(image.height));
  packet.put_channels(image.channels);
  return packet.take();
}

std::vector<unsigned char> update_image_packet(std::string_view name, const Image& image, int begin, int end) {
  Packet packet(Type::update_image, false, name);
  const size_t channels = image.channels.size(), row = size_t(image.width) * channels;
  packet.put_channels(image.channels);
  for (const int32_t v : {0, begin, image.width, end - begin}) packet.put(v);
  for (size_t c = 0; c < channels; ++c) packet.put(int64_t(c));         // offset of the channel's first value
  for (size_t c = 0; c < channels; ++c) packet.put(int64_t(channels));  // stride: the channels are interleaved
  packet.put(std::span(image.pixels).subspan(size_t(begin) * row, size_t(end - begin) * row));
  return packet.take();
}

}  // namespace frond
