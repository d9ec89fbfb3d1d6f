#pragma once

#include <optional>

#include "render/live_view.h"
#include "system/tcp_client.h"

namespace frond {

/// The viewer tev, or another that speaks its protocol (image/tev_packets.h).
class TevViewer final : public Viewer {
 public:
  /// `name`: of the image there. Nobody is called until something is to be shown.
  TevViewer(ServerAddress at, std::string name) : at_(std::move(at)), name_(std::move(name)) {}

  /// Of the first image what is not black, later what has changed; after `end` all of it.
  void show(const Image& image) override;
  void end(bool at_once) override;

 private:
  ServerAddress at_;
  std::string name_;
  Patience patience_{10};
  std::optional<TcpClient> client_;
  std::vector<float> sent_;
  std::atomic<bool> is_last_ = false;
};

}  // namespace frond
