// SPDX-License-Identifier: MIT
// Settings that change while a run goes on: what the car and its controller make of them.

#include "chicane/run/run_steps.hpp"
#include "support/alloc_guard.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"

namespace chicane::run {
namespace {

using telemetry::Change;
using test::Settings;

std::unique_ptr<ClosedLoop> loop_of(Settings settings) {
  settings.emplace_back("laps", "0");
  return test::loop_of(test::scenario_of(settings));
}

Setting setting(const char* name, const char* value, bool starts_anew = false) {
  if (starts_anew) return {.change = {.name = name, .value = value, .starts_anew = true}, .action = {}};
  const Result<Setting> read = read_setting({.name = name, .value = value});
  EXPECT_TRUE(read) << name;
  return read.value_or(Setting{});
}

/// Control cycles one after another; the frame of the last one.
const telemetry::Frame& drive(ClosedLoop& loop, int cycles) {
  for (int done = 0; done < cycles;) done += loop.advance() ? 1 : 0;
  while (!loop.is_control_due()) loop.advance();
  return loop.frame();
}

const telemetry::Frame& drive_to_map(ClosedLoop& loop) {
  for (int i = 0; i < 3000 && !loop.frame().result.report.has_map; ++i) drive(loop, 1);
  EXPECT_TRUE(loop.frame().result.report.has_map);
  return loop.frame();
}

TEST(LiveChange, HoldsFromTheNextControlStepOn) {
  const auto loop = loop_of({{"track", "oval"}});
  drive(*loop, 200);
  EXPECT_EQ(loop->frame().result.plan.size, 41);
  loop->apply({.name = "tracking_mpc.horizon_steps", .value = "20"});
  EXPECT_EQ(drive(*loop, 1).result.plan.size, 21);
  loop->apply({.name = "latency_ms", .value = "250"});
  EXPECT_DOUBLE_EQ(drive(*loop, 1).measurement.delay, 0.25);
  loop->apply({.name = "sensor.position_quantum_m", .value = "10"});
  const model::Measurement seen = drive(*loop, 1).measurement;
  EXPECT_EQ(std::fmod(seen.x, 10.0), 0.0);
  loop->apply({.name = "run.pace", .value = "0.5"});
  EXPECT_EQ(drive(*loop, 1).pace, 0.5);
  loop->apply({.name = "laps", .value = "17"});
  EXPECT_EQ(loop->summary().laps_wanted, 17);
}

TEST(LiveChange, OfWeightsHorizonAndSpeedKeepsTheMapAndTheCarOnTheRoad) {
  const auto loop = loop_of({{"track", "oval"}});
  drive_to_map(*loop);
  const Settings changes{{"tracking_mpc.weight_lateral", "4"},
                         {"tracking_mpc.horizon_steps", "60"},
                         {"tracking_mpc.step_length_s", "0.04"},
                         {"tracking_mpc.speed_limit_mps", "25"},
                         {"tracking_mpc.grip_share", "0.6"},
                         {"tracking_mpc.smoothing_width_m", "0.5"},
                         {"tracking_mpc.assumed_half_width_m", "2"},
                         {"tracking_mpc.horizon_steps", "25"},
                         {"vehicle.mass_kg", "1100"},
                         {"plant_options.mass_scale", "1.1"},
                         {"latency_ms", "40"},
                         {"latency_ms", "160"}};
  for (const auto& [name, value] : changes) {
    SCOPED_TRACE(name + "=" + value);
    loop->apply({.name = name, .value = value});
    for (int i = 0; i < 50; ++i) {
      const telemetry::Frame& frame = drive(*loop, 1);
      ASSERT_TRUE(frame.result.report.has_map);
      ASSERT_EQ(frame.guard.rung, controller::Rung::kController) << frame.cycle;
    }
  }
  EXPECT_EQ(loop->summary().off_track_events, 0);
  EXPECT_LT(loop->frame().truth.vx, 27.0);  // the limit of 25 m/s, set above, has been reached
}

TEST(LiveChange, ReachesEveryController) {
  for (const auto& [preset, key, value] :
       std::vector<std::array<std::string, 3>>{{"sixty-mph", "cubic_mpc.speed_reference_mps", "8"},
                                               {"sixty-mph", "cubic_mpc.horizon_steps", "14"},
                                               {"pid", "pid.speed_reference_mps", "8"},
                                               {"pure-pursuit", "pure_pursuit.speed_reference_mps", "8"},
                                               {"stanley", "stanley.speed_reference_mps", "8"}}) {
    SCOPED_TRACE(preset + " " + key);
    const auto one = loop_of({{"preset", preset}, {"track", "oval"}});
    const auto other = loop_of({{"preset", preset}, {"track", "oval"}});
    drive(*one, 100);
    drive(*other, 100);
    one->apply({.name = key, .value = value});
    const model::Command changed = drive(*one, 1).result.command;
    const model::Command same = drive(*other, 1).result.command;
    EXPECT_NE(std::pair(changed.steer, changed.throttle), std::pair(same.steer, same.throttle));
    EXPECT_EQ(one->frame().guard.rung, controller::Rung::kController);
  }
}

TEST(LiveChange, AllocatesNothing) {
  const auto loop = loop_of({{"track", "oval"}});
  drive_to_map(*loop);
  const std::vector<Setting> changes{setting("tracking_mpc.weight_lateral", "4"),
                                     setting("tracking_mpc.horizon_steps", "60"),
                                     setting("tracking_mpc.speed_limit_mps", "25"),
                                     setting("tracking_mpc.smoothing_width_m", "0.5"),
                                     setting("cubic_mpc.latency_handling", "position-only"),
                                     setting("vehicle.mass_kg", "1100"),
                                     setting("fault.ice_patch", "+0.5*0.9"),
                                     setting("run.pace", "2"),
                                     setting("manual.is_on", "true")};
  const test::AllocationGuard guard;
  for (const Setting& change : changes) {
    loop->apply(change);
    drive(*loop, 2);
  }
  EXPECT_EQ(guard.count(), 0);
}

TEST(LiveChange, SurvivesARestart) {
  const auto loop = loop_of({{"track", "oval"}});
  drive(*loop, 50);
  loop->apply({.name = "tracking_mpc.horizon_steps", .value = "20"});
  drive(*loop, 5);
  loop->restart();
  EXPECT_EQ(drive(*loop, 1).result.plan.reference_size, 21);
  // As if it had been set from the beginning.
  const auto fresh = loop_of({{"track", "oval"}, {"tracking_mpc.horizon_steps", "20"}});
  drive(*loop, 199);
  drive(*fresh, 200);
  EXPECT_EQ(loop->summary().state_hash, fresh->summary().state_hash);
}

TEST(LiveChange, OfFrictionAndMassIsThatOfACarBuiltSo) {
  for (const std::string car : {"udacity", "road-car"}) {
    SCOPED_TRACE(car);
    const auto built = loop_of({{"track", "oval"},
                                {"car", car},
                                {"plant_options.friction_scale", "0.7"},
                                {"plant_options.mass_scale", "1.2"}});
    const auto changed = loop_of({{"track", "oval"}, {"car", car}});
    changed->apply({.name = "plant_options.friction_scale", .value = "0.7"});
    changed->apply({.name = "plant_options.mass_scale", .value = "1.2"});
    changed->restart();
    drive(*built, 150);
    drive(*changed, 150);
    EXPECT_EQ(built->summary().state_hash, changed->summary().state_hash);
  }
}

TEST(ManualDriving, ReplacesTheControllersCommandThroughGateAndDelay) {
  const auto loop = loop_of({{"track", "oval"}});
  drive(*loop, 100);
  loop->apply({.name = "manual.is_on", .value = "true"});
  loop->apply({.name = "manual.steer", .value = "0.1"});
  loop->apply({.name = "manual.throttle", .value = "0.25"});
  const telemetry::Frame first = drive(*loop, 1);
  EXPECT_TRUE(first.is_manual);
  EXPECT_DOUBLE_EQ(first.result.command.steer, 0.1 * loop->scenario().vehicle.steer_limit);
  EXPECT_DOUBLE_EQ(first.result.command.throttle, 0.25);
  EXPECT_NE(first.asked.steer, first.result.command.steer);  // the controller's own
  EXPECT_GT(first.result.plan.size, 0);
  EXPECT_NE(first.applied.steer, first.result.command.steer);
  const telemetry::Frame& later = drive(*loop, 4);  // 160 ms
  EXPECT_DOUBLE_EQ(later.applied.steer, first.result.command.steer);
}

TEST(ManualDriving, HandsBackToAControllerThatKnowsWhereItIs) {
  const auto loop = loop_of({{"track", "oval"}});
  drive_to_map(*loop);
  loop->apply({.name = "manual.is_on", .value = "true"});
  loop->apply({.name = "manual.steer", .value = "0.05"});
  drive(*loop, 8);  // a third of a second towards the left edge
  loop->apply({.name = "manual.is_on", .value = "false"});
  for (int i = 0; i < 100; ++i) {
    const telemetry::Frame& frame = drive(*loop, 1);
    ASSERT_FALSE(frame.is_manual);
    ASSERT_EQ(frame.guard.rung, controller::Rung::kController);
    // Commands in flight, the person's too, are known: plans come true.
    if (i > 5 && std::isfinite(frame.prediction_error)) {
      ASSERT_LT(frame.prediction_error, 0.5) << i;
    }
  }
  EXPECT_EQ(loop->summary().off_track_events, 0);
}

TEST(RealtimeLoop, TakesUpChangesWhilePausedAndComesBackToStartAnew) {
  const auto loop = loop_of({{"track", "oval"}});
  RunControls controls;
  controls.is_paused = true;
  ASSERT_TRUE(controls.settings.push(setting("latency_ms", "30")));
  ASSERT_TRUE(controls.settings.push(setting("track", "lakeside", true)));
  int changes = 0;
  const telemetry::RunSummary run =
      run_realtime(*loop, {}, controls, {.on_change = [&](const Change&) { ++changes; }});
  EXPECT_EQ(run.cycles, 0U);
  EXPECT_EQ(changes, 1);
  EXPECT_EQ(loop->scenario().latency, 0.03);
  ASSERT_NE(controls.settings.front(), nullptr);
  EXPECT_TRUE(controls.settings.front()->change.starts_anew);
}

TEST(RealtimeLoop, GoesAtThePaceThatIsAskedFor) {
  const auto loop = loop_of({{"track", "oval"}, {"time_limit_s", "0.2"}});
  loop->apply({.name = "run.pace", .value = "0.5"});
  RunControls controls;
  // Slow motion can only take longer than asked for; an upper bound would test the machine.
  EXPECT_GE(run_realtime(*loop, {}, controls).wall_time, 0.39);
}

}  // namespace
}  // namespace chicane::run
