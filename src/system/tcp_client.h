#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace frond {

/// Where a server listens.
struct ServerAddress {
  std::string host;  ///< a name, or an IP address
  uint16_t port;     ///< 1 to 65535
  /// As it is parsed.
  std::string text() const;
};

/// Of "HOST:PORT", an IPv6 address in brackets. Throws InputError, which names the option.
ServerAddress parse_server_address(std::string_view text, std::string_view option);

/// How long the other side of a connection is waited for: so many seconds each time that nothing moves, and in no case
/// beyond an end, which another thread may set meanwhile.
class Patience {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Patience(double seconds) : seconds_(seconds) {}

  void end_at(Clock::time_point end) { end_ = end; }
  Clock::time_point end() const { return end_; }
  /// When a wait that begins now is over, unless the end comes first.
  Clock::time_point limit() const;

 private:
  std::chrono::duration<double> seconds_;
  std::atomic<Clock::time_point> end_ = Clock::time_point::max();
};

/// A connection to a server that is sent bytes and not listened to. Of a server that goes away it learns by an error,
/// not by SIGPIPE.
class TcpClient {
 public:
  /// `patience` must outlive it. Throws InputError, with the reason, where nobody answers.
  TcpClient(const ServerAddress& to, const Patience& patience);
  ~TcpClient();
  TcpClient(const TcpClient&) = delete;
  TcpClient& operator=(const TcpClient&) = delete;

  /// All of it. Throws InputError where the other side has gone or takes nothing more; nothing can be sent after that.
  void send(std::span<const unsigned char> bytes);

 private:
  std::string name_;
  const Patience& patience_;
  int socket_ = -1;
};

}  // namespace frond
