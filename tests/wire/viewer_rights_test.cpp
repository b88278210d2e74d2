// SPDX-License-Identifier: MIT
// Who may do what, and how much at once.
#include "wire/fake_viewer.hpp"

namespace chicane::wire {
namespace {

TEST_F(Viewer, ThatMayWatchOnlyChangesNothing) {
  Store store;
  ViewerOptions options;
  options.parameters = &store;
  bool is_paused = false;
  options.services.pause = [&](bool paused) -> Result<void> {
    is_paused = paused;
    return {};
  };
  start(std::move(options));
  connect(2, false);
  server.take();
  endpoint->on_message(2, R"({"op":"setParameters","parameters":[{"name":"a","value":7}],"id":"x"})", false);
  auto messages = server.take();
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_THAT(*messages[0].bytes, HasSubstr("this connection may watch only"));
  EXPECT_EQ(json::parse(*messages[1].bytes)["parameters"][0]["value"], 1.0);  // the slider springs back
  EXPECT_EQ(store.a, 1.0);
  endpoint->on_message(2, service_call(0, "\1"), true);
  EXPECT_THAT(answer()["message"].get<std::string>(), HasSubstr("this connection may watch only"));
  EXPECT_FALSE(is_paused);
  endpoint->on_message(2, R"({"op":"getParameters","parameterNames":["a"]})", false);
  EXPECT_EQ(answer()["parameters"].size(), 1U);
  endpoint->on_close(2, "");
  connect(2, false);  // rights are a connection's, not a number's
  server.take();
  endpoint->on_message(2, service_call(0, "\1"), true);
  EXPECT_FALSE(is_paused);
}

TEST_F(Viewer, WithoutAnyRightOrRoomIsRefused) {
  start({});
  net::UpgradeRequest request{.id = 5};
  request.subprotocols = {"foxglove.sdk.v1"};
  EXPECT_EQ(endpoint->on_upgrade(request).status, 403);
  request.may_watch = true;
  request.is_crowded = true;
  EXPECT_EQ(endpoint->on_upgrade(request).status, 503);
}

/// The numbers of laps in messages to viewer 2, in order: lap n ended at n seconds.
std::vector<double> laps_of(const std::vector<FakeServer::Sent>& messages) {
  std::vector<double> times;
  for (const FakeServer::Sent& message : messages) {
    if (message.to != 2 || !message.binary || message.bytes->front() != 1) continue;
    std::uint64_t time = 0;
    std::memcpy(&time, message.bytes->data() + 5, sizeof(time));
    times.push_back(1e-9 * static_cast<double>(time));
  }
  return times;
}

// After 256 laps no dashboard could connect: all were sent at once, and no more may wait for a connection.
TEST_F(Viewer, GetsAThousandLapsInPages) {
  start({});
  for (int lap = 1; lap <= 1000; ++lap) {
    endpoint->publish(telemetry::CompletedLap{}, lap);
    server.pass_time();
  }
  connect(2, false);
  server.take();
  endpoint->on_message(2, subscribe(4, "/chicane/lap"), false);
  std::vector<double> got = laps_of(server.take());
  EXPECT_EQ(got.size(), 192U);
  server.unread = 192;  // it reads nothing
  for (int i = 0; i < 10; ++i) server.pass_time();
  EXPECT_TRUE(laps_of(server.take()).empty());
  server.unread = 190;  // it reads slowly
  server.pass_time();
  for (const double lap : laps_of(server.take())) got.push_back(lap);
  EXPECT_EQ(got.size(), 194U);
  server.unread = 0;
  endpoint->publish(telemetry::CompletedLap{},
                    1001.0);     // one comes meanwhile, and takes the first one's place
  for (int i = 0; i < 6; ++i) {  // a tenth of a second
    server.pass_time();
    const std::vector<double> page = laps_of(server.take());
    EXPECT_LE(page.size(), 192U);
    got.insert(got.end(), page.begin(), page.end());
  }
  ASSERT_EQ(got.size(), 1001U);
  for (std::size_t i = 0; i < got.size(); ++i) ASSERT_DOUBLE_EQ(got[i], static_cast<double>(i + 1));
  EXPECT_TRUE(laps_of(server.take()).empty());
}

}  // namespace
}  // namespace chicane::wire
