// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "closed_loop/drive.hpp"

namespace chicane::run {
namespace {

using controller::Rung;

/// A car on the lakeside whose controller gets no waypoints from `blind_from` [s] for `lasts` [s].
struct BlindRun {
  double speed_before = 0.0;  ///< when the waypoints stopped [m/s]
  double lowest_speed = std::numeric_limits<double>::infinity();
  double speed_after = 0.0;  ///< at the end [m/s]
  Rung lowest_rung = Rung::kController;
  Rung last_rung = Rung::kController;
  int off_track_events = 0;
  bool is_bounded = true;
};

BlindRun drive_blind(double blind_from, double lasts, double end) {
  auto scenario = test::scenario_of({{"preset", "weighted"},
                                     {"track", "lakeside"},
                                     {"guard.mode", "off"},
                                     {"latency_ms", "100"},
                                     {"control_period_ms", "120"},
                                     {"laps", "0"}});
  scenario.faults = {{*sim::fault_named("waypoints_missing"), blind_from, lasts, 1.0}};
  const auto loop = test::loop_of(scenario);
  BlindRun run;
  while (loop->time() < end && !loop->is_over()) {
    if (!loop->advance()) continue;
    const telemetry::Frame& frame = loop->frame();
    const double speed = frame.measurement.speed;
    const model::Command& sent = frame.result.command;
    if (frame.time < blind_from) run.speed_before = speed;
    run.lowest_speed = frame.time < blind_from ? run.lowest_speed : std::min(run.lowest_speed, speed);
    run.speed_after = speed;
    run.lowest_rung = std::max(run.lowest_rung, frame.guard.rung);
    run.last_rung = frame.guard.rung;
    run.is_bounded &=
        std::fabs(sent.steer) <= scenario.vehicle.steer_limit && std::fabs(sent.throttle) <= 1.0;
  }
  run.off_track_events = loop->world().off_track_events;
  return run;
}

TEST(FallbackOnTheRoad, BridgesHalfASecondWithTheLastPlan) {
  const BlindRun run = drive_blind(20.0, 0.4, 30.0);
  EXPECT_EQ(run.lowest_rung, Rung::kShiftedPlan);
  EXPECT_EQ(run.last_rung, Rung::kController);
  EXPECT_EQ(run.off_track_events, 0);
  EXPECT_GT(run.lowest_speed, run.speed_before - 2.0);
}

TEST(FallbackOnTheRoad, BringsABlindCarToAStandAndKeepsItThere) {
  const BlindRun run = drive_blind(20.0, 1e9, 40.0);
  EXPECT_EQ(run.lowest_rung, Rung::kBrake);
  EXPECT_TRUE(run.is_bounded);
  EXPECT_GT(run.speed_before, 15.0);
  EXPECT_LT(run.speed_after, 0.5);  // and does not drive backwards, which the same pedal does below 5 mph
}

TEST(FallbackOnTheRoad, DrivesOnOnceTheWaypointsAreBack) {
  const BlindRun run = drive_blind(20.0, 1.5, 45.0);
  EXPECT_GE(run.lowest_rung, Rung::kHoldAndBrake);
  EXPECT_EQ(run.last_rung, Rung::kController);
  EXPECT_LT(run.lowest_speed, run.speed_before - 2.0);
  EXPECT_GT(run.speed_after, 15.0);
}

}  // namespace
}  // namespace chicane::run
