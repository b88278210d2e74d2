// SPDX-License-Identifier: MIT
#include "chicane/net/client.hpp"

#include <boost/beast/core/detail/base64.hpp>
#include <boost/uuid/detail/sha1.hpp>
#include <thread>

#include "chicane/net/server.hpp"
#include "net/raw_socket.hpp"
#include "support/chicane_test.hpp"

namespace chicane::net {
namespace {

using test::RawSocket;
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

/// What RFC 6455 §4.2.2 asks a server to answer.
std::string accept_of(const std::string& key) {
  boost::uuids::detail::sha1 hash;
  const std::string text = key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";
  hash.process_bytes(text.data(), text.size());
  unsigned int words[5];
  hash.get_digest(words);
  std::array<unsigned char, 20> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<unsigned char>(words[i / 4] >> (24 - 8 * (i % 4)));
  std::string text64(boost::beast::detail::base64::encoded_size(bytes.size()), ' ');
  boost::beast::detail::base64::encode(text64.data(), bytes.data(), bytes.size());
  return text64;
}

std::string key_of(const std::string& request) {
  const std::size_t start = request.find("Sec-WebSocket-Key: ") + 19;
  return request.substr(start, request.find("\r\n", start) - start);
}

TEST(Client, SendsTheOriginalRequestByteForByte) {
  std::string request;
  const FakeServer server([&](RawSocket& socket) {
    request = socket.until("\r\n\r\n");
    socket.send("HTTP/1.1 503 Service Unavailable\r\n\r\nbusy with another car\n");
  });
  EXPECT_THAT(test::refusal_of(Client::connect(server.url(), 5s)),
              HasSubstr("503 Service Unavailable: busy with another car"));
  std::string expected = test::unity_handshake(server.port());
  const std::string key = key_of(request);
  EXPECT_EQ(key.size(), 24U);
  expected.replace(expected.find("dGhlIHNhbXBsZSBub25jZQ=="), 24, key);
  EXPECT_EQ(request, expected);
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

TEST(Client, TalksToTheServerOfTheOriginalControllers) {
  // As uNetworking/uWebSockets e94b6e1 answers (HTTPSocket.cpp). It throws away bytes that come before its
  // answer.
  std::string early;
  std::string first;
  const FakeServer server([&](RawSocket& socket) {
    const std::string request = socket.until("\r\n\r\n");
    early = socket.until("anything", 50ms);
    socket.send(
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: "
        "Upgrade\r\nSec-WebSocket-Accept: " +
        accept_of(key_of(request)) +
        "\r\nSec-WebSocket-Version: 13\r\nWebSocket-Server: uWebSockets\r\n\r\n");
    first = socket.until("more than a frame of seven bytes, masked at random, can hold", 200ms);
    socket.send(
        "\x81\x05"
        "42[]\n"
        "\x81\x01"
        "x");  // two frames in one segment
    socket.rest();
  });
  auto client = test::good(Client::connect(server.url(), 5s));
  ASSERT_TRUE((*client)->send_text("2"));
  EXPECT_EQ((*client)->receive(5s).value().value(), "42[]\n");
  EXPECT_EQ((*client)->receive(5s).value().value(), "x");
  EXPECT_EQ(early, "");
  ASSERT_EQ(first.size(), 7U);
  EXPECT_EQ(first.substr(0, 2), "\x81\x81");  // a masked text frame of one byte
  EXPECT_EQ(static_cast<char>(first[6] ^ first[2]), '2');
  client->reset();
}

TEST(Client, SaysWhyItCannotConnect) {
  EXPECT_FALSE(Client::connect("ws://127.0.0.1:1/", 1s));
  for (const char* url : {"http://localhost", "ws://", "ws://:80/", "ws://host:0/", "ws://host:99999/",
                          "ws://host:12x/", "ws://a b/"}) {
    EXPECT_THAT(test::refusal_of(parse_url(url)), HasSubstr(std::string("got '") + url)) << url;
  }
}

TEST(Client, ReadsUrls) {
  const auto url = test::good(parse_url("ws://[::1]:4567/socket.io/?EIO=4"));
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
    auto created = test::good(
        Server::create({.port = 0, .max_message = 300'000, .idle_timeout = 200ms}, std::move(handlers), {}));
    owner_ = std::move(*created);
    auto connected =
        test::good(Client::connect("ws://127.0.0.1:" + std::to_string(owner_->port()) + "/any/path", 5s));
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
