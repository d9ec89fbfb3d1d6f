#include "system/tcp_client.h"

#include <gmock/gmock.h>

#include <thread>
#include <vector>

#include "tests/support/input_error.h"
#include "tests/support/tev_listener.h"

namespace frond {
namespace {

using test::Port;
using test::TevListener;
using ::testing::HasSubstr;

TEST(ServerAddresses, AreHostsAndPorts) {
  for (const char* text : {"localhost:14158", "127.0.0.1:1", "host-1.example.org:65535", "[::1]:14158"})
    EXPECT_EQ(parse_server_address(text, "--at").text(), text);
  EXPECT_EQ(parse_server_address("[::1]:14158", "--at").host, "::1");
  EXPECT_EQ(parse_server_address("[::1]:14158", "--at").port, 14158);
}

TEST(ServerAddresses, ThatAreNoneAreRefused) {
  for (const char* text :
       {"", ":", "localhost", "localhost:", ":14158", "localhost:0", "localhost:65536", "localhost:-1", "localhost:+1",
        "localhost: 1", "localhost:1x", "::1:14158", "[]:1", "[::1]", "[::1:1", "a b:1", "http://localhost:1"})
    EXPECT_THAT(error_of([&] { parse_server_address(text, "--at"); }),
                HasSubstr("--at takes HOST:PORT, such as localhost:14158"))
        << text;
}

TEST(TcpClients, SayWhyThereIsNoConnection) {
  const Port port;
  const Timeout timeout(10);
  EXPECT_THAT(error_of([&] {
                TcpClient({"127.0.0.1", port.number()}, timeout);
              }),
              HasSubstr("cannot connect to " + port.address() + ": Connection refused"));
  EXPECT_THAT(error_of([&] {
                TcpClient({"name.invalid", 1}, timeout);
              }),
              HasSubstr("cannot connect to name.invalid:1: "));
}

TEST(TcpClients, SendAllBytes) {
  TevListener listener(TevListener::Manner::reads);
  const Timeout timeout(60);
  std::vector<unsigned char> packet(10'000'000);  // one of nonsense
  packet[0] = 0x80, packet[1] = 0x96, packet[2] = 0x98;
  { TcpClient({"127.0.0.1", listener.port()}, timeout).send(packet); }
  listener.join();
  EXPECT_EQ(listener.bytes(), packet.size());
  EXPECT_THAT(listener.faults(), ::testing::ElementsAre("type 0 of \"\""));
}

TEST(TcpClients, LearnThatTheOtherSideHasGone) {
  TevListener listener(TevListener::Manner::closes_early);
  const Timeout timeout(60);
  TcpClient client({"127.0.0.1", listener.port()}, timeout);
  const std::vector<unsigned char> bytes(1 << 20);
  EXPECT_THAT(error_of([&] {
                for (;;) client.send(bytes);
              }),
              HasSubstr("has closed the connection: "));
}

TEST(TcpClients, WaitForTheirPatienceAndNoLonger) {
  const std::vector<unsigned char> bytes(64 << 20);
  {
    TevListener listener(TevListener::Manner::never_reads);
    const Timeout timeout(0.1);
    TcpClient client({"127.0.0.1", listener.port()}, timeout);
    EXPECT_THAT(error_of([&] { client.send(bytes); }), HasSubstr("takes no more data"));
  }
  TevListener listener(TevListener::Manner::never_reads);
  Timeout timeout(1e6);
  TcpClient client({"127.0.0.1", listener.port()}, timeout);
  std::jthread other([&timeout] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    timeout.set_deadline(Timeout::Clock::now());
  });
  EXPECT_THAT(error_of([&] { client.send(bytes); }), HasSubstr("data"));
}

}  // namespace
}  // namespace frond
