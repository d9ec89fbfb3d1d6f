#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace frond {

/// Image in memory: rows from top to bottom, the channels of a pixel next to each other.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<float> pixels;

  Image() = default;
  /// Image of zeros.
  Image(int w, int h, std::vector<std::string> names);

  /// Index of a channel; empty if there is none of this name.
  std::optional<size_t> channel(std::string_view name) const;
  const float& at(int x, int y, size_t channel) const { return pixels[index(x, y, channel)]; }
  float& at(int x, int y, size_t channel) { return pixels[index(x, y, channel)]; }

  /// Values of one channel, row by row.
  std::vector<float> plane(size_t channel) const;
  /// Image whose channel i is channel `which[i]` of this one, named `names[i]`; a channel can occur several times.
  Image selected(std::span<const size_t> which, std::vector<std::string> names) const;

 private:
  size_t index(int x, int y, size_t channel) const {
    return (size_t(y) * size_t(width) + size_t(x)) * channels.size() + channel;
  }
};

}  // namespace frond
