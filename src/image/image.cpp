#include "image/image.h"

#include <algorithm>

namespace frond {

Image::Image(int w, int h, std::vector<std::string> names)
    : width(w), height(h), channels(std::move(names)), pixels(size_t(w) * size_t(h) * channels.size()) {}

std::optional<size_t> Image::channel(std::string_view name) const {
  const auto it = std::find(channels.begin(), channels.end(), name);
  if (it == channels.end()) return {};
  return static_cast<size_t>(it - channels.begin());
}

}  // namespace frond
