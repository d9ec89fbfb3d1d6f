#include "core/image.h"

#include <algorithm>
#include <cassert>

namespace frond {

Image::Image(int w, int h, std::vector<std::string> names)
    : width(w), height(h), channels(std::move(names)), pixels(size_t(w) * size_t(h) * channels.size()) {}

std::optional<size_t> Image::channel(std::string_view name) const {
  const auto it = std::find(channels.begin(), channels.end(), name);
  if (it == channels.end()) return {};
  return static_cast<size_t>(it - channels.begin());
}

std::vector<float> Image::plane(size_t channel) const {
  std::vector<float> values;
  values.reserve(size_t(width) * size_t(height));
  for (size_t i = channel; i < pixels.size(); i += channels.size()) values.push_back(pixels[i]);
  return values;
}

Image Image::selected(std::span<const size_t> which, std::vector<std::string> names) const {
  assert(which.size() == names.size());
  Image result(width, height, std::move(names));
  auto to = result.pixels.begin();
  for (size_t pixel = 0; pixel < pixels.size(); pixel += channels.size())
    for (const size_t c : which) *to++ = pixels[pixel + c];
  return result;
}

}  // namespace frond
