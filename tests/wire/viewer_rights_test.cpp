// SPDX-License-Identifier: MIT
// Who may do what, and how much at once.
#include "wire/fake_viewer.hpp"

namespace chicane::wire {
namespace {

TEST_F(Viewer, ThatMayWatchOnlyChangesNothing) {
  Store store;
  ViewerOptions options{.parameters = &store};
  bool is_paused = false;
  options.services.pause = [&](bool paused) -> Result<void> {
    is_paused = paused;
    return {};
  };
  start(std::move(options));
  join(2);
  say(R"({"op":"setParameters","parameters":[{"name":"a","value":7}],"id":"x"})", 2);
  auto messages = server.take();
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_THAT(*messages[0].bytes, HasSubstr("this connection may watch only"));
  EXPECT_EQ(json::parse(*messages[1].bytes)["parameters"][0]["value"], 1.0);  // the slider springs back
  EXPECT_EQ(store.a, 1.0);
  endpoint->on_message(2, service_call(0, "\1"), true);
  EXPECT_THAT(answer()["message"].get<std::string>(), HasSubstr("this connection may watch only"));
  EXPECT_FALSE(is_paused);
  say(R"({"op":"getParameters","parameterNames":["a"]})", 2);
  EXPECT_EQ(answer()["parameters"].size(), 1U);
  endpoint->on_close(2, "");
  connect(2, false);  // rights are a connection's, not a number's
  server.take();
  endpoint->on_message(2, service_call(0, "\1"), true);
  EXPECT_FALSE(is_paused);
}

TEST_F(Viewer, NeedsARightRoomAndOneOfTheTwoSubprotocols) {
  start({});
  const auto answer_to = [&](bool may_watch, bool is_crowded, std::vector<std::string> offered) {
    net::UpgradeRequest request{.id = 5, .may_watch = may_watch};
    request.is_crowded = is_crowded;
    request.subprotocols = std::move(offered);
    return endpoint->on_upgrade(request);
  };
  EXPECT_EQ(answer_to(false, false, {"foxglove.sdk.v1"}).status, 403);
  EXPECT_EQ(answer_to(true, true, {"foxglove.sdk.v1"}).status, 503);
  EXPECT_EQ(answer_to(true, false, {"foxglove.websocket.v1"}).subprotocol, "foxglove.websocket.v1");
  EXPECT_EQ(answer_to(true, false, {"foxglove.websocket.v1", "foxglove.sdk.v1"}).subprotocol,
            "foxglove.sdk.v1");
  EXPECT_FALSE(answer_to(true, false, {"soap"}).accept);
}

// After 256 laps no dashboard could connect: all were sent at once, and no more may wait for a connection.
TEST_F(Viewer, GetsAThousandLapsInPages) {
  start({});
  for (int lap = 1; lap <= 1000; ++lap) {
    endpoint->publish(telemetry::CompletedLap{}, lap);
    server.pass_time();
  }
  join(2);
  say(subscribe(4, "/chicane/lap"), 2);
  std::vector<double> got = times_of(server.take(), 2, 4);
  EXPECT_EQ(got.size(), 192U);
  server.unread = 192;  // it reads nothing
  for (int i = 0; i < 10; ++i) server.pass_time();
  EXPECT_TRUE(times_of(server.take(), 2, 4).empty());
  server.unread = 190;  // it reads slowly
  server.pass_time();
  for (const double lap : times_of(server.take(), 2, 4)) got.push_back(lap);
  EXPECT_EQ(got.size(), 194U);
  server.unread = 0;
  endpoint->publish(telemetry::CompletedLap{},
                    1001.0);     // one comes meanwhile, and takes the first one's place
  for (int i = 0; i < 6; ++i) {  // a tenth of a second
    server.pass_time();
    const std::vector<double> page = times_of(server.take(), 2, 4);
    EXPECT_LE(page.size(), 192U);
    got.insert(got.end(), page.begin(), page.end());
  }
  ASSERT_EQ(got.size(), 1001U);
  for (std::size_t i = 0; i < got.size(); ++i) ASSERT_DOUBLE_EQ(got[i], static_cast<double>(i + 1));
  EXPECT_TRUE(times_of(server.take(), 2, 4).empty());
}

}  // namespace
}  // namespace chicane::wire
