// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "chicane/controller/cubic_mpc.hpp"
#include "chicane/road/track.hpp"
#include "chicane/run/make.hpp"
#include "chicane/sim/sensor.hpp"
#include "chicane/sim/world.hpp"
#include "closed_loop/drive.hpp"
#include "support/guarded.hpp"

namespace chicane::run {
namespace {

using controller::Rung;

/// A car on the lakeside whose controller stops getting waypoints at `blind_from` [s] and gets them back at
/// `sees_at`.
struct BlindRun {
  double speed_before = 0.0;  ///< when the waypoints stopped [m/s]
  double lowest_speed = std::numeric_limits<double>::infinity();
  double speed_after = 0.0;  ///< at the end [m/s]
  Rung lowest_rung = Rung::kController;
  Rung last_rung = Rung::kController;
  int off_track_events = 0;
  bool is_bounded = true;
};

BlindRun drive_blind(double blind_from, double sees_at, double end) {
  const auto scenario = test::scenario_of({{"preset", "weighted"}, {"track", "lakeside"}});
  const auto track = run::make_track(scenario);
  const auto plant = std::move(*run::make_plant(scenario));
  test::Guarded mpc(std::move(*run::make_controller(scenario)), scenario.vehicle);
  sim::World world{*plant, *track};
  sim::Sensor sensor{{}, 1};
  sim::ActuationDelay in_flight;
  in_flight.reset({});
  BlindRun run;
  for (double next = 0.0; world.time() < end;) {
    const double time = world.time();
    if (time >= next - 1e-9) {
      model::Measurement now = sensor.sample(time, *plant);
      now.delay = 0.1;
      const bool is_blind = time >= blind_from && time < sees_at;
      if (!is_blind) sim::select_waypoints(*track, {now.x, now.y, now.psi}, 6, now);
      const test::Sent& answer = mpc.step(now, Deadline::never());
      if (time < blind_from) run.speed_before = now.speed;
      run.lowest_speed = time < blind_from ? run.lowest_speed : std::min(run.lowest_speed, now.speed);
      run.speed_after = now.speed;
      run.lowest_rung = std::max(run.lowest_rung, answer.guard.rung);
      run.last_rung = answer.guard.rung;
      run.is_bounded = run.is_bounded && std::fabs(answer.command.steer) <= scenario.vehicle.steer_limit &&
                       std::fabs(answer.command.throttle) <= 1.0;
      in_flight.push(time + 0.1, answer.command);
      next += 0.12;
    }
    world.advance(in_flight.at(world.time() + 1e-9));
  }
  run.off_track_events = world.state().off_track_events;
  return run;
}

TEST(FallbackOnTheRoad, BridgesHalfASecondWithTheLastPlan) {
  const BlindRun run = drive_blind(20.0, 20.4, 30.0);
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
  const BlindRun run = drive_blind(20.0, 21.5, 45.0);
  EXPECT_GE(run.lowest_rung, Rung::kHoldAndBrake);
  EXPECT_EQ(run.last_rung, Rung::kController);
  EXPECT_LT(run.lowest_speed, run.speed_before - 2.0);
  EXPECT_GT(run.speed_after, 15.0);
}

}  // namespace
}  // namespace chicane::run
