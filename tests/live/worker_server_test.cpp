// SPDX-License-Identifier: MIT
#include "chicane/live/worker_run.hpp"
#include "support/chicane_test.hpp"

namespace chicane::live {
namespace {

class InWorker : public testing::Test {
 protected:
  std::vector<std::string> sent, events;
  bool accepts = true;
  net::Server* started = nullptr;
  WorkerServer server{
      {.on_start = [this](net::Server& self) { started = &self; },
       .on_upgrade =
           [this](const net::UpgradeRequest& request) {
             EXPECT_TRUE(request.may_control);
             return net::UpgradeAnswer{.accept = accepts, .endpoint = 7};
           },
       .on_open = [this](net::ConnectionId,
                         int endpoint) { events.push_back("open " + std::to_string(endpoint)); },
       .on_message = [this](net::ConnectionId, int, std::string_view bytes,
                            bool) { events.emplace_back(bytes); },
       .on_close = [this](net::ConnectionId, int, std::string_view) { events.emplace_back("close"); },
       .on_get = [](std::string_view path) -> std::optional<net::Content> {
         if (path != "/page") return std::nullopt;
         return net::Content{.bytes = "content"};
       }},
      [this](std::string_view bytes, bool) { sent.emplace_back(bytes); }};

  void say(const std::string& text, net::Delivery delivery = net::Delivery::kReliable,
           std::uint32_t topic = 0) {
    server.send(WorkerServer::kPage, std::make_shared<const std::string>(text), false, delivery, topic);
  }
};

TEST_F(InWorker, ConnectsThePageAndConnectsItAnew) {
  EXPECT_EQ(started, &server);
  say("nobody is there");
  server.receive("nor here", false);
  EXPECT_TRUE(server.connect());
  server.receive("hello", false);
  EXPECT_TRUE(server.connect());
  server.close(WorkerServer::kPage, 1000, "");
  server.close(WorkerServer::kPage, 1000, "");
  EXPECT_EQ(events, (std::vector<std::string>{"open 7", "hello", "close", "open 7", "close"}));
  EXPECT_TRUE(sent.empty());
  accepts = false;
  EXPECT_FALSE(server.connect());
  EXPECT_EQ(server.get("/page")->bytes, "content");
  EXPECT_FALSE(server.get("/other"));
}

TEST_F(InWorker, HoldsBackWhatThePageHasNotTakenAndOfFramesTheNewest) {
  ASSERT_TRUE(server.connect());
  for (std::size_t i = 0; i < WorkerServer::kInFlight; ++i) say("first");
  say("lap");
  for (const char* frame : {"a", "b", "c"}) say(frame, net::Delivery::kNewest, 1);
  say("other", net::Delivery::kNewest, 2);
  EXPECT_EQ(sent.size(), WorkerServer::kInFlight);
  EXPECT_EQ(server.waiting(WorkerServer::kPage), WorkerServer::kInFlight + 3);
  server.acknowledge(2);
  EXPECT_EQ(std::vector(sent.end() - 2, sent.end()), (std::vector<std::string>{"lap", "c"}));
  server.acknowledge(1000);
  EXPECT_EQ(sent.back(), "other");
  EXPECT_EQ(server.waiting(WorkerServer::kPage), 1U);
}

}  // namespace
}  // namespace chicane::live
