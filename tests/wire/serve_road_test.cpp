// SPDX-License-Identifier: MIT
// What serve makes of the road that it was told.

#include "protocol/hostile_telemetry.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"
#include "wire/served.hpp"

namespace chicane::wire {
namespace {

using test::kRealTelemetry;
using test::RawSocket;
using test::Served;
using test::steer_of;

/// A circle about the origin, 5 m to each edge.
road::Track circle(double radius) { return test::circle_road(radius, 100, 5.0, 5.0, {}); }

TEST(Serve, SaysOnceThatTheToldRoadIsAnotherOneAndJudgesNothingByIt) {
  const road::Track track = circle(60.0);  // the message's waypoints are 118 m from the origin and less
  Served served(&ServeOptions::track, &track);
  RawSocket client = served.connect();
  for (int i = 0; i < 3; ++i) {
    client.send(RawSocket::masked(kRealTelemetry));
    EXPECT_GT(steer_of(client.frame())["throttle"].get<double>(), 0.0) << "it is driven";
  }
  EXPECT_TRUE(served.has_logged("another road at 59"));
  served.stop();
  EXPECT_EQ(served.count_logged("another road"), 1);
  EXPECT_EQ(served.summary().run.track, "");
  EXPECT_EQ(served.summary().run.off_track_events, 0);
}

TEST(Serve, JudgesByTheToldRoadWhereItFits) {
  const road::Track track = circle(118.0);
  Served served(&ServeOptions::track, &track);
  RawSocket client = served.connect();
  client.send(RawSocket::masked(kRealTelemetry));
  steer_of(client.frame());
  served.stop();
  EXPECT_EQ(served.count_logged("another road"), 0);
  EXPECT_EQ(served.summary().run.track, "circle");
}

}  // namespace
}  // namespace chicane::wire
