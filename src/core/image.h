#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace frond {

/// Pixels in memory: rows from the top, channels next to each other.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<float> pixels;

  Image() = default;
  /// Black.
  Image(int w, int h, std::vector<std::string> names);

  std::optional<size_t> channel(std::string_view name) const;
  const float& at(int x, int y, size_t channel) const { return pixels[index(x, y, channel)]; }
  float& at(int x, int y, size_t channel) { return pixels[index(x, y, channel)]; }

  /// One channel's values, pixel by pixel.
  std::vector<float> plane(size_t channel) const;
  /// An image of some of the channels, each as often as it is there, under other names.
  Image selected(std::span<const size_t> which, std::vector<std::string> names) const;

 private:
  size_t index(int x, int y, size_t channel) const {
    return (size_t(y) * size_t(width) + size_t(x)) * channels.size() + channel;
  }
};

}  // namespace frond
