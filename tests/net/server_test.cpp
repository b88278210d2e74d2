// SPDX-License-Identifier: MIT
#include "chicane/net/server.hpp"

#include <future>

#include "net/raw_socket.hpp"
#include "net/recorder.hpp"
#include "support/chicane_test.hpp"

namespace chicane::net {
namespace {

using test::RawSocket;
using test::Recorder;
using test::unity_handshake;
using test::upgraded;
using namespace std::chrono_literals;

const Asset kPage{.path = "/index.html", .content_type = "text/html", .content = "<h1>hello</h1>"};

/// Status and reason in the close frame that comes next.
std::string goodbye_of(RawSocket& socket) {
  const auto frame = test::good(socket.frame());
  EXPECT_EQ(frame->opcode, 8);
  return frame->payload;
}

std::string get(std::uint16_t port, const std::string& target, const std::string& extra = {},
                const std::string& method = "GET") {
  RawSocket socket(port);
  socket.send(method + " " + target + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + extra +
              "\r\n");
  return socket.rest();
}

TEST(Server, AnswersTheOriginalUpgradeRequestWithoutAnyExtra) {
  Recorder recorder;
  RawSocket socket(recorder.port());
  socket.send(unity_handshake(recorder.port()));
  const std::string head = socket.until("\r\n\r\n");
  EXPECT_THAT(head, StartsWith("HTTP/1.1 101 Switching Protocols\r\n"));
  EXPECT_THAT(head, HasSubstr("\r\nUpgrade: websocket\r\n"));
  EXPECT_THAT(head, HasSubstr("\r\nConnection: Upgrade\r\n"));
  EXPECT_THAT(head,
              HasSubstr("\r\nSec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n"));  // RFC 6455 §1.3
  EXPECT_THAT(head, Not(HasSubstr("Sec-WebSocket-Protocol")));
  EXPECT_THAT(head, Not(HasSubstr("Sec-WebSocket-Extensions")));
  EXPECT_EQ(recorder.upgrade().target, "/socket.io/?EIO=4&transport=websocket");
  EXPECT_EQ(recorder.upgrade().origin, "");
}

TEST(Server, NeverNegotiatesCompressionAndReturnsTheChosenSubprotocol) {
  Recorder recorder;
  recorder.answer({.accept = true, .subprotocol = "b"});
  RawSocket socket(recorder.port());
  std::string request = unity_handshake(recorder.port());
  request.insert(request.size() - 2,
                 "Sec-WebSocket-Extensions: permessage-deflate\r\nSec-WebSocket-Protocol: a, b\r\n");
  socket.send(request);
  const std::string head = socket.until("\r\n\r\n");
  EXPECT_THAT(head, HasSubstr("Sec-WebSocket-Protocol: b\r\n"));
  EXPECT_THAT(head, Not(HasSubstr("Extensions")));
  EXPECT_THAT(recorder.upgrade().subprotocols, ElementsAre("a", "b"));
}

TEST(Server, CarriesMessagesBothWaysInOrder) {
  Recorder recorder;
  RawSocket socket = upgraded(recorder.port());
  const ConnectionId id = recorder.opened(1).at(0);
  socket.send(RawSocket::masked("one") + RawSocket::masked("two"));
  EXPECT_THAT(recorder.messages(2), ElementsAre("one", "two"));
  recorder.server().send(id, std::string("first"), false);
  recorder.server().send(id, std::string("\x00\x01", 2), true);
  const auto first = socket.frame();
  const auto second = socket.frame();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->opcode, 1);
  EXPECT_EQ(first->payload, "first");
  EXPECT_EQ(second->opcode, 2);
  EXPECT_EQ(second->payload, std::string("\x00\x01", 2));
}

TEST(Server, ClosesWithCodeAndReasonAfterWhatWaits) {
  Recorder recorder;
  RawSocket socket = upgraded(recorder.port());
  const ConnectionId id = recorder.opened(1).at(0);
  recorder.server().send(id, std::string("last words"), false);
  recorder.server().close(id, 1013, "come back later");
  EXPECT_EQ(socket.frame()->payload, "last words");
  EXPECT_EQ(goodbye_of(socket), std::string("\x03\xf5") + "come back later");
  socket.send(RawSocket::masked("\x03\xf5", 8));
  socket.close();
  EXPECT_THAT(recorder.closed(1), ElementsAre("come back later"));
}

TEST(Server, RefusesAnUpgradeInWords) {
  Recorder recorder;
  recorder.answer({.accept = false, .status = 503, .reason = "another simulator is connected"});
  RawSocket socket(recorder.port());
  socket.send(unity_handshake(recorder.port()));
  const std::string answer = socket.rest();
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 503"));
  EXPECT_THAT(answer, HasSubstr("another simulator is connected"));
}

TEST(Server, RefusesStrangersBeforeAnybodyIsAsked) {
  Recorder recorder;
  for (const auto& [host, origin] : std::vector<std::pair<std::string, std::string>>{
           {"evil.example", ""}, {"localhost", "http://evil.example"}, {"localhost", "null"}}) {
    RawSocket socket(recorder.port());
    socket.send("GET / HTTP/1.1\r\nHost: " + host + "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n" +
                (origin.empty() ? "" : "Origin: " + origin + "\r\n") +
                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n");
    EXPECT_THAT(socket.rest(), StartsWith("HTTP/1.1 403")) << host << " " << origin;
  }
  EXPECT_EQ(recorder.upgrade().target, "");
}

/// Tools write an extra field, a name, a comment and a check of the header before what is compressed.
TEST(Server, ServesAssetsWithTheirHeadersAndNothingElse) {
  using namespace std::string_view_literals;
  // printf 'hello hello hello hello' | gzip -n -9
  constexpr auto kGreeting =
      "\x1f\x8b\x08\0\0\0\0\0\x02\x03\xcb\x48\xcd\xc9\xc9\x57\xc8\x40\x27\x01\xe3\x51\x3d\x8d\x17\0\0\0"sv;
  Recorder recorder(
      {},
      {kPage, {.path = "/app.js", .content_type = "text/javascript", .content = kGreeting, .gzip = true}});
  const std::string page = get(recorder.port(), "/?view=map");
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy: default-src 'self'"));
  EXPECT_THAT(page, HasSubstr("X-Content-Type-Options: nosniff"));
  EXPECT_THAT(page, HasSubstr("\r\n\r\n<h1>hello</h1>"));
  const std::string compressed = get(recorder.port(), "/app.js", "Accept-Encoding: gzip, br\r\n");
  EXPECT_THAT(compressed, HasSubstr("Content-Encoding: gzip"));
  EXPECT_THAT(compressed, HasSubstr("\r\n\r\n" + std::string(kGreeting)));
  for (const char* asked : {"", "Accept-Encoding: identity\r\n"}) {
    const std::string refusal = get(recorder.port(), "/app.js", asked);
    EXPECT_THAT(refusal, StartsWith("HTTP/1.1 406")) << asked;
    EXPECT_THAT(refusal, HasSubstr("with gzip only")) << asked;
  }
  EXPECT_THAT(get(recorder.port(), "/../etc/passwd"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(get(recorder.port(), "/favicon.ico"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(get(recorder.port(), "/", {}, "DELETE"), StartsWith("HTTP/1.1 405"));
  const std::string head = get(recorder.port(), "/", {}, "HEAD");
  EXPECT_THAT(head, HasSubstr("Content-Length: 14\r\n"));
  EXPECT_THAT(head, Not(HasSubstr("hello")));
}

TEST(Server, DoesNotSendAnAssetTwice) {
  Recorder recorder({}, {kPage});
  const std::string page = get(recorder.port(), "/");
  const std::size_t start = page.find("ETag: ") + 6;
  const std::string tag = page.substr(start, page.find("\r\n", start) - start);
  EXPECT_THAT(get(recorder.port(), "/", "If-None-Match: " + tag + "\r\n"), StartsWith("HTTP/1.1 304"));
}

TEST(Server, AsksForAContentBeforeItLooksForAnAsset) {
  Recorder recorder({}, {kPage}, [](std::string_view path) -> std::optional<Content> {
    if (path != "/mode.json") return std::nullopt;
    return Content{.content_type = "application/json", .bytes = R"({"mode":"live"})"};
  });
  const std::string answer = get(recorder.port(), "/mode.json?x=1");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(answer, HasSubstr("Content-Type: application/json\r\n"));
  EXPECT_THAT(answer, HasSubstr("X-Content-Type-Options: nosniff"));
  EXPECT_THAT(answer, HasSubstr("\r\n\r\n{\"mode\":\"live\"}"));
  EXPECT_THAT(get(recorder.port(), "/mode.json", "Range: bytes=2-5\r\n"), HasSubstr("\r\n\r\nmode"));
  const std::string head = get(recorder.port(), "/mode.json", {}, "HEAD");
  EXPECT_THAT(head, HasSubstr("Content-Length: 15\r\n"));
  EXPECT_THAT(head, Not(HasSubstr("live")));
  EXPECT_THAT(get(recorder.port(), "/"), HasSubstr("hello"));
  EXPECT_THAT(get(recorder.port(), "/mode.json/../x"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(get(recorder.port(), "/mode.json", "Origin: http://evil.example\r\n"),
              StartsWith("HTTP/1.1 403"));
}

TEST(Server, AnswersTheNextRequestOnTheSameConnection) {
  Recorder recorder({}, {}, [](std::string_view path) {
    return Content{.content_type = "text/plain", .bytes = std::string(100'000, path.back()) + "end"};
  });
  RawSocket socket(recorder.port());
  for (const char* path : {"/a", "/b"}) {
    socket.send("GET " + std::string(path) + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_THAT(socket.until("\r\n\r\n"), HasSubstr("Content-Length: 100003"));
    EXPECT_EQ(socket.until("end"), std::string(100'000, path[1]) + "end");
  }
}

TEST(Server, AnswersBrokenRequestsWithoutHarm) {
  Recorder recorder({.handshake_timeout = 200ms});
  const auto reply = [&](const std::string& bytes) {
    RawSocket socket(recorder.port());
    socket.send(bytes);
    return socket.rest();
  };
  const std::string start = "GET / HTTP/1.1\r\nHost: localhost\r\n";
  EXPECT_THAT(reply("nonsense\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(reply("GET / HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(reply(start + "Host: localhost\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(reply(start + "Filler: " + std::string(9000, 'x') + "\r\n\r\n"), StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(reply(start + "Content-Length: 5\r\n\r\nhello"), StartsWith("HTTP/1.1 4"));
  EXPECT_THAT(reply(unity_handshake(recorder.port()) + "early"), StartsWith("HTTP/1.1 400"));
  EXPECT_EQ(reply("GET / HT"), "");  // a drip: closed when its time is up
  std::string old = unity_handshake(recorder.port());
  old.replace(old.find("Version: 13"), 11, "Version: 12");
  EXPECT_THAT(reply(old), StartsWith("HTTP/1.1 426"));
  RawSocket still_there = upgraded(recorder.port());
}

TEST(Server, ClosesWith1009WhenAMessageIsTooLarge) {
  Recorder recorder({.max_message = 1000});
  RawSocket socket = upgraded(recorder.port());
  socket.send(RawSocket::masked(std::string(1001, 'x')));
  EXPECT_THAT(goodbye_of(socket), StartsWith("\x03\xf1"));
  socket.close();
  EXPECT_THAT(recorder.closed(1).at(0), HasSubstr("more than 1000 bytes"));
}

TEST(Server, Refuses503WhenThereAreTooManyConnections) {
  Recorder recorder({.max_connections = 2});
  const RawSocket first = upgraded(recorder.port());
  const RawSocket second = upgraded(recorder.port());
  RawSocket third(recorder.port());
  EXPECT_THAT(third.rest(), StartsWith("HTTP/1.1 503"));
}

// 1,024 connections that said nothing left no place for the simulator.
TEST(Server, ConnectionsThatAskForNothingGiveWayToNewOnes) {
  Recorder recorder({.max_connections = 20, .handshake_timeout = 60s, .idle_timeout = 60s});
  std::vector<RawSocket> idle;
  for (int i = 0; i < 60; ++i) idle.emplace_back(recorder.port());
  const RawSocket simulator = upgraded(recorder.port());
  EXPECT_EQ(recorder.opened(1).size(), 1U);
  EXPECT_EQ(idle.front().rest(), "");  // the oldest was ended without a word
}

TEST(Server, TellsAnEndpointWhenOnlyTheLastPlacesAreLeft) {
  Recorder recorder({.max_connections = 16});
  std::vector<RawSocket> open;
  for (std::size_t i = 0; i < 14; ++i) {
    open.push_back(upgraded(recorder.port()));
    EXPECT_FALSE(recorder.upgrade().is_crowded) << i;
    ASSERT_EQ(recorder.opened(i + 1).size(), i + 1);
  }
  open.push_back(upgraded(recorder.port()));
  EXPECT_TRUE(recorder.upgrade().is_crowded);
}

/// Eight viewers that read nothing yet. 100 messages of 20 kB for each are within max_queue, and 16 MB
/// together.
struct Crowd {
  Recorder recorder{{.idle_timeout = 60s, .max_waiting = 4'000'000}};
  std::vector<RawSocket> viewers;
  Crowd() {
    for (std::size_t i = 0; i < 8; ++i) {
      viewers.push_back(upgraded(recorder.port(), 4096));
      recorder.opened(i + 1);
    }
  }
};

TEST(Server, BoundsTheMemoryOfAllConnectionsTogether) {
  Crowd crowd;
  for (int i = 0; i < 100; ++i)
    for (const ConnectionId id : crowd.recorder.opened(8))
      crowd.recorder.server().send(id, std::string(20'000, 'x'), false);
  const std::vector<std::string> ended = crowd.recorder.closed(4);
  EXPECT_GE(ended.size(), 4U);
  EXPECT_EQ(ended.front(), "does not read what it is sent");
}

TEST(Server, WhatIsSentToManyCountsOnce) {
  Crowd crowd;
  for (int i = 0; i < 100; ++i) {
    const auto shared = std::make_shared<const std::string>(20'000, 'x');
    for (const ConnectionId id : crowd.recorder.opened(8)) crowd.recorder.server().send(id, shared, false);
  }
  for (RawSocket& viewer : crowd.viewers)
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(viewer.frame()) << i;
}

TEST(Server, NeedsATokenToListenForOtherMachines) {
  EXPECT_THAT(test::refusal_of(Server::create({.address = "0.0.0.0", .port = 0}, {}, {})),
              StartsWith("address: got 0.0.0.0 without a token"));
}

TEST(Server, ALinkWithTheTokenBecomesACookieAndThePageItself) {
  Recorder recorder({.address = "0.0.0.0", .token = "secret"}, {kPage});
  EXPECT_THAT(get(recorder.port(), "/"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(get(recorder.port(), "/?token=guess"), StartsWith("HTTP/1.1 403"));
  const std::string answer = get(recorder.port(), "/?token=secret");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 303"));
  EXPECT_THAT(answer, HasSubstr("\r\nLocation: /\r\n"));
  const std::string cookie = "chicane-" + std::to_string(recorder.port()) + "=secret";
  EXPECT_THAT(answer, HasSubstr("\r\nSet-Cookie: " + cookie + "; Path=/; HttpOnly; SameSite=Strict\r\n"));
  EXPECT_THAT(get(recorder.port(), "/", "Cookie: " + cookie + "\r\n"), HasSubstr("<h1>hello</h1>"));
  const RawSocket viewer = upgraded(recorder.port());  // the simulator's path: the endpoint decides
  EXPECT_FALSE(recorder.upgrade().may_watch);
  EXPECT_FALSE(recorder.upgrade().may_control);
}

TEST(Server, PagesMayOpenSocketsToTheirOwnHostOnly) {
  Recorder recorder({}, {kPage});
  EXPECT_THAT(get(recorder.port(), "/"), HasSubstr("; connect-src 'self' ws://localhost wss://localhost; "));
}

TEST(Server, NewestWinsForASlowReaderAndNobodyWaits) {
  Recorder recorder({.idle_timeout = 60s});
  RawSocket slow = upgraded(recorder.port(), 4096);
  const ConnectionId id = recorder.opened(1).at(0);
  const std::string filler(20'000, '.');
  constexpr int kFrames = 2000;  // 40 MB, far more than any socket buffer
  for (int i = 0; i < kFrames; ++i) {
    recorder.server().send(id, std::to_string(i) + filler, false, Delivery::kNewest, 7);
  }
  recorder.server().send(id, std::string("end"), false);
  int received = 0;
  std::string last;
  for (auto frame = slow.frame(); frame; frame = slow.frame()) {
    if (frame->payload == "end") break;
    last = frame->payload.substr(0, frame->payload.find('.'));
    ++received;
  }
  EXPECT_EQ(last, std::to_string(kFrames - 1));
  EXPECT_LT(received, kFrames / 2);
}

TEST(Server, EndsAReliableConnectionThatDoesNotRead) {
  Recorder recorder({.idle_timeout = 60s, .max_queue = 8});
  const RawSocket stuck = upgraded(recorder.port(), 4096);
  const ConnectionId id = recorder.opened(1).at(0);
  for (int i = 0; i < 500; ++i) recorder.server().send(id, std::string(20'000, 'x'), false);
  EXPECT_THAT(recorder.closed(1), ElementsAre("does not read what it is sent"));
}

TEST(Server, PingsASilentPeerAndEndsOneThatDoesNotAnswer) {
  Recorder recorder({.idle_timeout = 200ms});
  RawSocket silent = upgraded(recorder.port());
  EXPECT_EQ(silent.frame()->opcode, 9);
  EXPECT_THAT(recorder.closed(1), ElementsAre("silent for 200 ms"));
}

TEST(Server, NoticesACloseAndAPlainEnd) {
  Recorder recorder;
  RawSocket polite = upgraded(recorder.port());
  polite.send(RawSocket::masked(std::string("\x03\xe8", 2), 8));
  EXPECT_EQ(polite.frame()->opcode, 8);
  polite.close();
  EXPECT_THAT(recorder.closed(1).at(0), HasSubstr("closed by the peer (1000)"));
  RawSocket hasty = upgraded(recorder.port());
  hasty.send(RawSocket::masked(std::string("\x03\xe8", 2), 8));
  hasty.close();
  EXPECT_THAT(recorder.closed(2).at(1), HasSubstr("closed by the peer (1000)"));
  upgraded(recorder.port()).close();
  EXPECT_THAT(recorder.closed(3).at(2), HasSubstr("without a close frame"));
}

TEST(Server, NamesTheHolderOfABusyPort) {
  Recorder recorder;
  const auto second = Server::create({.port = recorder.port()}, {}, {});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::kIo);
  EXPECT_THAT(second.error().message,
              HasSubstr("port " + std::to_string(recorder.port()) + " is in use by "));
  EXPECT_THAT(second.error().message, HasSubstr("pid " + std::to_string(::getpid())));
}

TEST(Server, SaysGoodbyeWhenItEnds) {
  auto recorder = std::make_unique<Recorder>();
  RawSocket socket = upgraded(recorder->port());
  static_cast<void>(recorder->opened(1));
  recorder.reset();
  EXPECT_THAT(goodbye_of(socket), StartsWith("\x03\xe9"));  // 1001 going away
}

// A page on a busy machine reads late: nothing that it was sent is lost, and it learns that the program
// ended.
TEST(Server, WaitsForAPeerThatIsBehindBeforeItEnds) {
  auto recorder = std::make_unique<Recorder>(ServerOptions{.goodbye = std::chrono::seconds{20}});
  RawSocket socket = upgraded(recorder->port());
  const ConnectionId id = recorder->opened(1).front();
  const std::string message(100'000, 'x');
  constexpr int kMessages = 40;  // more than the kernel takes for a peer that does not read
  for (int i = 0; i < kMessages; ++i)
    recorder->server().send(id, std::make_shared<const std::string>(message), false, Delivery::kReliable, 0);
  std::thread end([&] { recorder.reset(); });
  for (int i = 0; i < kMessages; ++i) {
    const auto frame = socket.frame();
    ASSERT_TRUE(frame) << i;
    EXPECT_EQ(frame->payload.size(), message.size()) << i;
  }
  EXPECT_THAT(goodbye_of(socket), StartsWith("\x03\xe9"));
  socket.send(RawSocket::masked("\x03\xe9", 8));
  socket.close();
  end.join();
}

TEST(Server, RunsTasksInOrderOfTheirTimeAndServesMeanwhile) {
  Recorder recorder({}, {kPage});
  std::promise<std::string> order;
  std::string seen;
  recorder.server().run_after(300ms, [&] {
    seen += "late";
    order.set_value(seen);
  });
  recorder.server().run_after(0ms, [&] { seen += "soon "; });
  EXPECT_THAT(get(recorder.port(), "/"), HasSubstr("hello"));
  EXPECT_EQ(order.get_future().get(), "soon late");
}

std::string status(unsigned code) { return {static_cast<char>(code >> 8U), static_cast<char>(code)}; }

/// The status of the one close frame that answers a close frame with this payload.
std::string answer_to_close(const Recorder& recorder, const std::string& payload) {
  RawSocket socket = upgraded(recorder.port());
  socket.send(RawSocket::masked(payload, 8));
  const std::string status = goodbye_of(socket).substr(0, 2);
  EXPECT_EQ(socket.rest(), "");
  return status;
}

TEST(Server, EchoesAClosingStatusAndAnswersABrokenCloseFrameWithAProtocolError) {
  Recorder recorder;
  for (const unsigned code : {1000U, 1001U, 1011U, 3000U, 4999U})
    EXPECT_EQ(answer_to_close(recorder, status(code) + "why"), status(code)) << code;
  for (const std::string& broken :
       {status(999) + "why", status(1006), std::string("\x03"), status(1000) + "\xff"})
    EXPECT_EQ(answer_to_close(recorder, broken), status(1002)) << broken;
}

}  // namespace
}  // namespace chicane::net
