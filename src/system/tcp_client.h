#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace frond {

/// Address of a server.
struct ServerAddress {
  std::string host;  ///< host name or IP address, IPv6 without brackets
  uint16_t port;     ///< 1 to 65535
  /// Returns HOST:PORT, as parse_server_address accepts it.
  std::string text() const;
};

/// Parses "HOST:PORT"; an IPv6 address is in brackets. Throws InputError, which names the command-line `option`.
ServerAddress parse_server_address(std::string_view text, std::string_view option);

/// Time-outs of a connection: a limit in seconds for each wait, and a deadline for all of them. Another thread may set
/// the deadline during a wait.
class Timeout {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Timeout(double seconds) : seconds_(seconds) {}

  /// Sets the deadline; without it there is none.
  void set_deadline(Clock::time_point end) { end_ = end; }
  Clock::time_point deadline() const { return end_; }
  /// Returns when a wait that begins now ends, unless the deadline is earlier.
  Clock::time_point limit() const;

 private:
  std::chrono::duration<double> seconds_;
  std::atomic<Clock::time_point> end_ = Clock::time_point::max();
};

/// TCP connection to a server, for sending only. A closed connection is reported by an exception, not by SIGPIPE. Use
/// by one thread at a time.
class TcpClient {
 public:
  /// Connects. `timeout` must outlive this object. Throws InputError, with the reason, if no connection is made in
  /// time.
  TcpClient(const ServerAddress& to, const Timeout& timeout);
  ~TcpClient();
  TcpClient(const TcpClient&) = delete;
  TcpClient& operator=(const TcpClient&) = delete;

  /// Sends all bytes. Throws InputError if the server has closed the connection or a time-out expires; the connection
  /// is then unusable.
  void send(std::span<const unsigned char> bytes);

 private:
  std::string name_;
  const Timeout& timeout_;
  int socket_ = -1;
};

}  // namespace frond
