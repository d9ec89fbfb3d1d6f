#pragma once

#include <optional>

#include "render/live_view.h"
#include "system/tcp_client.h"

namespace frond {

/// The viewer tev, or another program with the same protocol (image/tev_packets.h).
class TevViewer final : public Viewer {
 public:
  /// `name` is the name of the image in the viewer. The first call of `show` opens the connection.
  TevViewer(ServerAddress at, std::string name) : at_(std::move(at)), name_(std::move(name)) {}

  /// Sends the rows of tiles that have changed since the last call, in the first call those that are not black, and
  /// after `end` all of them. Throws InputError if the connection fails.
  void show(const Image& image) override;
  void end(bool at_once) override;

 private:
  ServerAddress at_;
  std::string name_;
  Timeout timeout_{10};
  std::optional<TcpClient> client_;
  std::vector<float> sent_;
  std::atomic<bool> is_last_ = false;
};

}  // namespace frond
