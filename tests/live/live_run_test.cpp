// SPDX-License-Identifier: MIT
#include "chicane/live/live_run.hpp"

#include <thread>

#include "chicane/live/run_publisher.hpp"
#include "chicane/recording/replay.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"
#include "telemetry/sample_mcap.hpp"

namespace chicane::live {
namespace {

scenario::Scenario laps_of_oval(const std::string& laps) {
  return test::scenario_of({{"preset", "pid"}, {"track", "oval"}, {"laps", laps}});
}

/// A run at 20 times the pace of the clock, on a port of the system's choice.
Result<std::unique_ptr<LiveRun>> fast_run(const scenario::Scenario& scenario, run::RunControls& controls,
                                          LiveRunOptions options = {}) {
  options.server.port = 0;
  if (!options.pace) options.pace = 20.0;
  return LiveRun::create(options, std::move(*run::ClosedLoop::create(scenario)), controls);
}

TEST(LiveRun, DrivesToItsEndAndRecordsAllOfItWithItsChanges) {
  scenario::Scenario scenario = laps_of_oval("1");
  scenario.time_limit = 8.0;
  run::RunControls controls;
  const auto live = test::good(fast_run(scenario, controls));
  EXPECT_NE((*live)->port(), 0);
  const telemetry::TemporaryFile file;
  auto recorder = test::good(recording::Recorder::create(
      {.path = file.path(), .run = (*live)->description(), .scenario = scenario, .may_wait = true}));
  const test::Settings changes{{"pid.speed_reference_mps", "9"},
                               {"latency_ms", "220"},
                               {"latency_ms", "20"},
                               {"plant_options.friction_scale", "0.9"},
                               {"sensor.heading_noise_deg", "0.1"},
                               {"manual.is_on", "true"},
                               {"manual.steer", "0.03"},
                               {"manual.throttle", "-1"},
                               {"manual.is_on", "false"}};
  std::uint64_t frames = 0;
  const telemetry::RunSummary summary = (*live)->run(
      recorder->get(), {.on_frame = [&](const telemetry::Frame& frame) {
        if (++frames % 5 != 0 || frames / 5 > changes.size()) return;
        const auto& [name, value] = changes[frames / 5 - 1];
        EXPECT_TRUE(controls.settings.push(
            *run::read_setting({.cycle = frame.cycle, .time = frame.time, .name = name, .value = value})));
      }});
  EXPECT_EQ(summary.end_reason, "time limit reached");
  EXPECT_EQ(summary.cycles, frames);
  ASSERT_TRUE((*recorder)->finish());
  const auto replayed = test::good(recording::verify_recording(file.path()));
  EXPECT_TRUE(replayed->is_verified());
  EXPECT_EQ(replayed->steps, summary.cycles);
}

TEST(LiveRun, TellsOfEachLapTheLastOneToo) {
  const scenario::Scenario scenario =
      test::scenario_of({{"preset", "default"}, {"track", "oval"}, {"laps", "1"}});
  run::RunControls controls;
  controls.wants_stop = false;
  const auto live = test::good(fast_run(scenario, controls));
  std::vector<int> laps;
  const telemetry::RunSummary summary =
      (*live)->run(nullptr, {.on_lap = [&](const telemetry::CompletedLap& lap) { laps.push_back(lap.lap); }});
  EXPECT_TRUE(summary.completed);
  EXPECT_EQ(laps, (std::vector{1}));
}

TEST(LiveRun, BeginsWithAPersonAtTheWheelWhenAsked) {
  scenario::Scenario scenario = laps_of_oval("1");
  scenario.time_limit = 1.0;
  run::RunControls controls;
  LiveRunOptions options;
  options.is_manual = true;
  const auto live = test::good(fast_run(scenario, controls, options));
  bool was_always_manual = true;
  static_cast<void>((*live)->run(
      nullptr, {.on_frame = [&](const telemetry::Frame& frame) { was_always_manual &= frame.is_manual; }}));
  EXPECT_TRUE(was_always_manual);
}

TEST(LiveRun, StopsWhenAskedAndRefusesAPaceThatIsNone) {
  run::RunControls controls;
  LiveRunOptions options;
  options.pace = 1000.0;
  const auto refused = fast_run(laps_of_oval("1"), controls, options);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("run.pace: got 1000"), std::string::npos);

  run::RunControls stopping;
  const auto live = test::good(fast_run(laps_of_oval("0"), stopping));
  int frames = 0;
  const telemetry::RunSummary summary = (*live)->run(
      nullptr, {.on_frame = [&](const telemetry::Frame&) { stopping.wants_stop = ++frames == 20; }});
  EXPECT_EQ(summary.end_reason, "stopped");
  EXPECT_EQ(frames, 20);
}

}  // namespace
}  // namespace chicane::live
