// SPDX-License-Identifier: MIT
#include "chicane/net/client.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <thread>

#include "chicane/net/server.hpp"
#include "net/raw_socket.hpp"

namespace chicane::net {
namespace {

using test::RawSocket;
using testing::HasSubstr;
using namespace std::chrono_literals;

/// Accepts one connection and lets `script` play the server, as uWebSockets or something worse.
class FakeServer {
 public:
  explicit FakeServer(std::function<void(RawSocket&)> script) {
    listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    ::bind(listener_, reinterpret_cast<const sockaddr*>(&address), size);
    ::listen(listener_, 1);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this, script = std::move(script)] {
      RawSocket socket = RawSocket::of(::accept(listener_, nullptr, nullptr));
      script(socket);
    });
  }
  ~FakeServer() {
    thread_.join();
    ::close(listener_);
  }
  FakeServer(const FakeServer&) = delete;
  FakeServer& operator=(const FakeServer&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string url() const {
    return "ws://127.0.0.1:" + std::to_string(port_) + "/socket.io/?EIO=4&transport=websocket";
  }

 private:
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

/// that.
std::string key_of(const std::string& request) {
  const std::size_t start = request.find("Sec-WebSocket-Key: ") + 19;
  return request.substr(start, request.find("\r\n", start) - start);
}

TEST(Client, SendsTheOriginalRequestByteForByte) {
  std::string request;
  {
    const FakeServer server([&](RawSocket& socket) {
      request = socket.until("\r\n\r\n");
      socket.send("HTTP/1.1 503 Service Unavailable\r\n\r\nbusy with another car\n");
    });
    const auto client = Client::connect(server.url(), 5s);
    ASSERT_FALSE(client);
    EXPECT_THAT(client.error().message, HasSubstr("503 Service Unavailable: busy with another car"));
    std::string expected = test::unity_handshake(server.port());
    const std::string key = key_of(request);
    EXPECT_EQ(key.size(), 24U);
    expected.replace(expected.find("dGhlIHNhbXBsZSBub25jZQ=="), 24, key);
    EXPECT_EQ(request, expected);
  }
}

TEST(Client, RefusesAWrongAcceptKeyAndASilentServer) {
  const FakeServer wrong([](RawSocket& socket) {
    socket.until("\r\n\r\n");
    socket.send(
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n\r\n");
  });
  EXPECT_THAT(Client::connect(wrong.url(), 5s).error().message, HasSubstr("Sec-WebSocket-Accept is wrong"));
  const FakeServer silent([](RawSocket& socket) { socket.rest(); });
  EXPECT_THAT(Client::connect(silent.url(), 50ms).error().message, HasSubstr("does not answer the upgrade"));
}

TEST(Client, SaysWhyItCannotConnect) {
  EXPECT_FALSE(Client::connect("ws://127.0.0.1:1/", 1s));
  for (const char* url :
       {"http://localhost", "ws://", "ws://host:0/", "ws://host:99999/", "ws://host:12x/", "ws://a b/"}) {
    const auto parsed = parse_url(url);
    ASSERT_FALSE(parsed) << url;
    EXPECT_THAT(parsed.error().message, HasSubstr(std::string("got '") + url)) << url;
  }
}

TEST(Client, ReadsUrls) {
  const auto url = parse_url("ws://[::1]:4567/socket.io/?EIO=4");
  ASSERT_TRUE(url);
  EXPECT_EQ(url->host, "::1");
  EXPECT_EQ(url->port, 4567);
  EXPECT_EQ(url->target, "/socket.io/?EIO=4");
  EXPECT_EQ(parse_url("ws://localhost")->port, 80);
}

/// Against our own server, which checks masking, UTF-8 and framing strictly.
class ClientAndServer : public testing::Test {
 protected:
  void SetUp() override {
    ServerHandlers handlers{.on_start = [this](Server& server) { server_ = &server; },
                            .on_upgrade = [](const UpgradeRequest&) { return UpgradeAnswer{.accept = true}; },
                            .on_open = [](ConnectionId, int) {},
                            .on_message =
                                [this](ConnectionId id, int, std::string_view bytes, bool binary) {
                                  if (bytes == "close") return server_->close(id, 1013, "later");
                                  if (bytes != "silence") server_->send(id, std::string(bytes), binary);
                                },
                            .on_close = [](ConnectionId, int, std::string_view) {}};
    auto created =
        Server::create({.port = 0, .max_message = 300'000, .idle_timeout = 200ms}, std::move(handlers), {});
    ASSERT_TRUE(created);
    owner_ = std::move(*created);
    auto connected = Client::connect("ws://127.0.0.1:" + std::to_string(owner_->port()) + "/any/path", 5s);
    ASSERT_TRUE(connected) << connected.error().message;
    client_ = std::move(*connected);
  }

  Server* server_ = nullptr;
  std::unique_ptr<Server> owner_;
  std::unique_ptr<Client> client_;
};

TEST_F(ClientAndServer, EchoesMessagesOfAllSizes) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{125}, std::size_t{126},
                                 std::size_t{65'535}, std::size_t{65'536}, std::size_t{200'000}}) {
    const std::string text(size, 'x');
    ASSERT_TRUE(client_->send_text(text));
    const auto echo = client_->receive(5s);
    ASSERT_TRUE(echo && *echo) << size;
    EXPECT_EQ(**echo, text);
  }
}

TEST_F(ClientAndServer, ATimeOutIsNoErrorAndPingsAreAnsweredWhileWaiting) {
  ASSERT_TRUE(client_->send_text("silence"));
  const auto nothing = client_->receive(500ms);  // more than twice the server's idle time-out
  ASSERT_TRUE(nothing) << nothing.error().message;
  EXPECT_FALSE(*nothing);
  ASSERT_TRUE(client_->send_text("still here"));
  EXPECT_EQ(client_->receive(5s).value().value(), "still here");
}

TEST_F(ClientAndServer, ReportsWhyTheServerClosed) {
  ASSERT_TRUE(client_->send_text("close"));
  EXPECT_THAT(client_->receive(5s).error().message, HasSubstr("1013 later"));
  EXPECT_FALSE(client_->receive(5s));
  EXPECT_FALSE(client_->send_text("anyone?"));
}

}  // namespace
}  // namespace chicane::net
