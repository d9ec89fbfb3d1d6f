#include "system/tcp_client.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <future>
#include <memory>
#include <thread>

#include "core/error.h"

namespace frond {
namespace {

struct FreeAddresses {
  void operator()(addrinfo* list) const { freeaddrinfo(list); }
};
using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

/// Result of getaddrinfo: an error number, or 0 and the addresses.
struct Lookup {
  int error;
  Addresses found;
};

Lookup resolve_address(const ServerAddress& at, int flags) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = flags | AI_NUMERICSERV;
  addrinfo* list = nullptr;
  const int error = getaddrinfo(at.host.c_str(), std::to_string(at.port).c_str(), &hints, &list);
  return {error, Addresses(error == 0 ? list : nullptr)};
}

/// Calls `ready` with a time to wait until it returns true. Returns false when the time is over. Each wait is at most
/// 50 ms, because another thread may set the deadline meanwhile.
template <class Ready>
bool wait_until(const Timeout& timeout, const Ready& ready) {
  using namespace std::chrono_literals;
  const auto limit = timeout.limit();
  for (;;) {
    const auto left = std::min(limit, timeout.deadline()) - Timeout::Clock::now();
    if (ready(std::clamp(std::chrono::ceil<std::chrono::milliseconds>(left), 0ms, 50ms))) return true;
    if (left <= 0s) return false;
  }
}

/// Numeric addresses need no look-up. A name is looked up in a detached thread, because getaddrinfo has no time-out.
Addresses addresses_of(const ServerAddress& at, const Timeout& timeout) {
  Lookup lookup = resolve_address(at, AI_NUMERICHOST);
  if (lookup.error != 0) {
    std::packaged_task<Lookup()> task([at] { return resolve_address(at, 0); });
    std::future<Lookup> result = task.get_future();
    std::thread(std::move(task)).detach();
    if (!wait_until(timeout, [&](auto time) { return result.wait_for(time) == std::future_status::ready; }))
      fail({}, "cannot connect to {}: the name was not found in time", at.text());
    lookup = result.get();
  }
  if (lookup.error != 0) fail({}, "cannot connect to {}: {}", at.text(), gai_strerror(lookup.error));
  return std::move(lookup.found);
}

/// Returns whether the socket accepts bytes, or has an error, before the time is over.
bool wait_for(int socket, const Timeout& timeout) {
  return wait_until(timeout, [socket](std::chrono::milliseconds time) {
    pollfd wanted{socket, POLLOUT, 0};
    return poll(&wanted, 1, int(time.count())) > 0;
  });
}

/// Connects a non-blocking socket. Returns an error number, or 0.
int connect_to(int socket, const addrinfo& to, const Timeout& timeout) {
  if (connect(socket, to.ai_addr, to.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS && errno != EINTR) return errno;
  if (!wait_for(socket, timeout)) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof error;
  return getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

}  // namespace

std::string ServerAddress::text() const {
  return host.find(':') == std::string::npos ? fmt::format("{}:{}", host, port) : fmt::format("[{}]:{}", host, port);
}

ServerAddress parse_server_address(std::string_view text, std::string_view option) {
  const size_t colon = text.rfind(':');
  std::string_view host = text.substr(0, std::min(colon, text.size()));
  const std::string_view digits = colon == std::string_view::npos ? "" : text.substr(colon + 1);
  uint16_t port = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  const bool has_brackets = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (has_brackets) host = host.substr(1, host.size() - 2);
  const bool is_host = !host.empty() && (has_brackets || host.find_first_of(":[]") == std::string_view::npos) &&
                       host.find_first_of(std::string_view(" \t\n\0", 4)) == std::string_view::npos;
  if (!is_host || error != std::errc() || end != digits.data() + digits.size() || port == 0)
    fail({}, "{} takes HOST:PORT, such as localhost:14158 or [::1]:14158, with a port from 1 to 65535: \"{}\"", option,
         text);
  return {std::string(host), port};
}

Timeout::Clock::time_point Timeout::limit() const {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(seconds_);
}

TcpClient::TcpClient(const ServerAddress& to, const Timeout& timeout) : name_(to.text()), timeout_(timeout) {
  int error = 0;
  const Addresses all = addresses_of(to, timeout);
  for (const addrinfo* address = all.get(); address; address = address->ai_next) {
    socket_ = socket(address->ai_family, address->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, address->ai_protocol);
    error = socket_ < 0 ? errno : connect_to(socket_, *address, timeout);
    if (error == 0) return;
    if (socket_ >= 0) close(socket_);
    socket_ = -1;
  }
  fail({}, "cannot connect to {}: {}", name_, std::strerror(error));
}

TcpClient::~TcpClient() { close(socket_); }

void TcpClient::send(std::span<const unsigned char> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent >= 0)
      bytes = bytes.subspan(size_t(sent));
    else if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)
      fail({}, "{} has closed the connection: {}", name_, std::strerror(errno));
    else if (!wait_for(socket_, timeout_))
      fail({}, "{} takes no more data", name_);
    if (Timeout::Clock::now() >= timeout_.deadline() && !bytes.empty()) fail({}, "{} takes data too slowly", name_);
  }
}

}  // namespace frond
