#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace frond::test {

/// A port of this machine, bound by a socket; nobody listens there until `listen`.
class Port {
 public:
  Port() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&at), size), 0);
    EXPECT_EQ(::getsockname(socket_, reinterpret_cast<sockaddr*>(&at), &size), 0);
    number_ = ntohs(at.sin_port);
  }
  ~Port() { ::close(socket_); }
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  uint16_t number() const { return number_; }
  std::string address() const { return "127.0.0.1:" + std::to_string(number_); }
  void listen() const { EXPECT_EQ(::listen(socket_, 4), 0); }
  /// Reduces the system's buffer of unread data.
  void take_little() const {
    const int bytes = 4096;
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
  }
  /// The connection's descriptor, or -1 if `ended` comes first.
  int accept(const std::atomic<bool>& ended) const {
    pollfd wanted{socket_, POLLIN, 0};
    while (::poll(&wanted, 1, 10) <= 0)
      if (ended) return -1;
    return ::accept(socket_, nullptr, nullptr);
  }

 private:
  int socket_;
  uint16_t number_ = 0;
};

/// A viewer that speaks tev's protocol, in a separate thread. Reads packets in the format of tev's Ipc.h and records
/// their errors.
class TevListener {
 public:
  enum class Manner { reads, closes_early, never_reads };
  struct Shown {
    int width = 0, height = 0;
    std::vector<std::string> channels;
    std::map<std::string, std::vector<float>> values;  ///< by channel
    std::vector<int> updates;                          ///< of each pixel
  };

  explicit TevListener(Manner manner = Manner::reads) : manner_(manner) {
    if (manner == Manner::never_reads) port_.take_little();
    port_.listen();
    thread_ = std::thread([this] { run(); });
  }
  ~TevListener() { join(); }
  TevListener(const TevListener&) = delete;
  TevListener& operator=(const TevListener&) = delete;

  std::string address() const { return port_.address(); }
  uint16_t port() const { return port_.number(); }
  /// To be called after the client has finished. All received packets are then available.
  void join() {
    ended_ = true;
    if (thread_.joinable()) thread_.join();
  }
  /// Images by name.
  const std::map<std::string, Shown>& images() const { return images_; }
  const std::vector<std::string>& faults() const { return faults_; }
  /// Bytes that have been read up to now.
  size_t bytes() const { return bytes_; }

 private:
  /// Reads the content of a packet, and records a premature end.
  class Reader {
   public:
    Reader(const std::vector<unsigned char>& bytes, size_t at, size_t end) : bytes_(bytes), at_(at), end_(end) {}
    template <class Integer>
    Integer integer() {
      uint64_t value = 0;
      for (size_t i = 0; i < sizeof(Integer); ++i) value |= uint64_t(next()) << (8 * i);
      return static_cast<Integer>(value);
    }
    float real() { return std::bit_cast<float>(integer<uint32_t>()); }
    std::string string() {
      std::string text;
      while (const unsigned char c = next()) text += char(c);
      return text;
    }
    std::vector<std::string> strings() {
      std::vector<std::string> all;
      const auto count = integer<int32_t>();
      for (int32_t i = 0; i < count && is_whole_; ++i) all.push_back(string());
      return all;
    }
    size_t left() const { return end_ - at_; }
    bool is_whole() const { return is_whole_; }

   private:
    unsigned char next() {
      if (at_ < end_) return bytes_[at_++];
      is_whole_ = false;
      return 0;
    }
    const std::vector<unsigned char>& bytes_;
    size_t at_, end_;
    bool is_whole_ = true;
  };

  void run() {
    const int connection = port_.accept(ended_);
    if (connection < 0) return;
    std::vector<unsigned char> bytes, piece(1 << 16);
    pollfd wanted{connection, POLLIN, 0};
    if (manner_ == Manner::never_reads) {
      while (!ended_) std::this_thread::sleep_for(std::chrono::milliseconds(10));
      ::close(connection);
      return;
    }
    for (;;) {
      if (::poll(&wanted, 1, 10) <= 0) continue;
      const ssize_t count = ::recv(connection, piece.data(), piece.size(), 0);
      if (count <= 0) break;
      bytes_ += size_t(count);
      if (manner_ == Manner::closes_early) break;
      bytes.insert(bytes.end(), piece.begin(), piece.begin() + count);
      size_t at = 0;
      while (bytes.size() - at >= 4) {
        const auto length = Reader(bytes, at, at + 4).integer<uint32_t>();
        if (length < 6) {
          note("a packet of " + std::to_string(length) + " bytes");
          ::close(connection);
          return;
        }
        if (bytes.size() - at < length) break;
        take(Reader(bytes, at + 4, at + length));
        at += length;
      }
      bytes.erase(bytes.begin(), bytes.begin() + ptrdiff_t(at));
    }
    if (manner_ == Manner::reads && !bytes.empty()) note("half a packet at the end");
    ::close(connection);
  }

  void take(Reader packet) {
    const auto type = packet.integer<uint8_t>();
    const auto grabs_focus = packet.integer<uint8_t>();
    const std::string name = packet.string();
    if (grabs_focus > 1) note("focus is 0 or 1");
    if (type == 4)
      create(packet, images_[name]);
    else if (type == 6 && images_.contains(name))
      update(packet, images_[name]);
    else
      return note("type " + std::to_string(type) + " of \"" + name + "\"");
    if (!packet.is_whole()) note("a packet ends too soon");
    if (packet.left() > 0) note("a packet is too long");
  }

  void create(Reader& packet, Shown& image) {
    if (image.width > 0) note("an image is made twice");
    image.width = packet.integer<int32_t>(), image.height = packet.integer<int32_t>();
    image.channels = packet.strings();
    if (image.width <= 0 || image.height <= 0) return note("an image without pixels");
    const size_t pixels = size_t(image.width) * size_t(image.height);
    image.updates.assign(pixels, 0);
    for (const std::string& channel : image.channels) image.values[channel].assign(pixels, 0);
  }

  void update(Reader& packet, Shown& image) {
    const std::vector<std::string> channels = packet.strings();
    const auto x = packet.integer<int32_t>(), y = packet.integer<int32_t>(), width = packet.integer<int32_t>(),
               height = packet.integer<int32_t>();
    if (x < 0 || y < 0 || width <= 0 || height <= 0 || x + width > image.width || y + height > image.height)
      return note("an update beyond the image");
    std::vector<int64_t> offsets, strides;
    for (size_t c = 0; c < channels.size(); ++c) offsets.push_back(packet.integer<int64_t>());
    for (size_t c = 0; c < channels.size(); ++c) strides.push_back(packet.integer<int64_t>());
    std::vector<float> values;
    while (packet.left() >= 4) values.push_back(packet.real());
    const size_t pixels = size_t(width) * size_t(height);
    for (size_t c = 0; c < channels.size(); ++c) {
      const auto to = image.values.find(channels[c]);
      if (to == image.values.end()) return note("an update of no channel of the image: " + channels[c]);
      for (size_t i = 0; i < pixels; ++i) {
        const size_t from = size_t(offsets[c]) + i * size_t(strides[c]);
        if (from >= values.size()) return note("values are missing");
        to->second[(size_t(y) + i / size_t(width)) * size_t(image.width) + size_t(x) + i % size_t(width)] =
            values[from];
      }
    }
    for (int row = y; row < y + height; ++row)
      for (int column = x; column < x + width; ++column) ++image.updates[size_t(row * image.width + column)];
  }

  void note(std::string fault) { faults_.push_back(std::move(fault)); }

  Manner manner_;
  Port port_;
  std::atomic<bool> ended_ = false;
  std::atomic<size_t> bytes_ = 0;
  std::map<std::string, Shown> images_;
  std::vector<std::string> faults_;
  std::thread thread_;
};

}  // namespace frond::test
