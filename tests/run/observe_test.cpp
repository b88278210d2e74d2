// SPDX-License-Identifier: MIT
#include "chicane/run/observe.hpp"

#include <gtest/gtest.h>

#include "chicane/run/closed_loop.hpp"

namespace chicane::run {
namespace {

sim::WorldState some_state() {
  sim::WorldState state;
  state.s = 120.0;
  state.lateral_error = -0.4;
  state.heading_error = 0.02;
  state.edge_distance = 1.5;
  state.is_off_track = true;
  state.lap = 3;
  state.lap_time = 12.5;
  state.last_lap_time = 41.0;
  state.off_track_events = 2;
  return state;
}

TEST(Observe, WritesWhatTheJudgeSaysAndThatThereIsOne) {
  telemetry::Frame frame;
  observe(some_state(), frame);
  EXPECT_TRUE(frame.is_judged);
  EXPECT_EQ(frame.s, 120.0);
  EXPECT_EQ(frame.lateral_error, -0.4);
  EXPECT_EQ(frame.heading_error, 0.02);
  EXPECT_EQ(frame.edge_distance, 1.5);
  EXPECT_TRUE(frame.is_off_track);
  EXPECT_EQ(frame.lap, 3U);
  EXPECT_EQ(frame.lap_time, 12.5);
  EXPECT_EQ(frame.last_lap_time, 41.0);
  EXPECT_EQ(frame.off_track_events, 2U);
}

TEST(Observe, AJudgeKnowsNoTruthAndLeavesTheRest) {
  telemetry::Frame frame;
  frame.time = 7.0;
  frame.measurement.speed = 20.0;
  observe(some_state(), frame);
  EXPECT_FALSE(frame.has_truth);
  EXPECT_EQ(frame.truth.vx, 0.0);
  EXPECT_EQ(frame.time, 7.0);
  EXPECT_EQ(frame.measurement.speed, 20.0);
}

TEST(Observe, AWorldKnowsTheTruth) {
  scenario::Scenario scenario;
  const auto loop = ClosedLoop::create(scenario);
  ASSERT_TRUE(loop) << loop.error().message;
  while ((*loop)->time() < 2.0) (*loop)->advance();
  const telemetry::Frame& frame = (*loop)->frame();
  EXPECT_TRUE(frame.has_truth);
  EXPECT_TRUE(frame.is_judged);
  EXPECT_GT(frame.truth.vx, 1.0);
  EXPECT_NE(frame.longitudinal_acceleration, 0.0);
  EXPECT_GT(frame.s, 1.0);
}

}  // namespace
}  // namespace chicane::run
