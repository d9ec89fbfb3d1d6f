#include "render/tev_viewer.h"

#include <algorithm>

#include "image/tev_packets.h"

namespace frond {

void TevViewer::show(const Image& image) {
  if (!client_) {
    client_.emplace(at_, timeout_);
    client_->send(create_image_packet(name_, image));
    sent_.resize(image.pixels.size());
  }
  const size_t row = size_t(image.width) * image.channels.size();
  for (int y = 0; y < image.height; y += Film::kTile) {
    const int end = std::min(y + Film::kTile, image.height);
    const auto first = image.pixels.begin() + ptrdiff_t(size_t(y) * row),
               last = image.pixels.begin() + ptrdiff_t(size_t(end) * row);
    const auto before = sent_.begin() + ptrdiff_t(size_t(y) * row);
    if (!is_last_ && std::equal(first, last, before)) continue;
    client_->send(update_image_packet(name_, image, y, end));
    std::copy(first, last, before);
  }
}

void TevViewer::end(bool at_once) {
  constexpr std::chrono::seconds kMostSeconds{3};
  timeout_.set_deadline(Timeout::Clock::now() + (at_once ? std::chrono::seconds{0} : kMostSeconds));
  is_last_ = true;
}

}  // namespace frond
