// SPDX-License-Identifier: MIT

#include "closed_loop/drive.hpp"

namespace chicane::run {
namespace {

/// `preset` on the lakeside with 100 ms, its own compensation replaced by `handling`.
telemetry::RunSummary with_handling(const char* preset, const char* handling, const Settings& more = {}) {
  Settings settings{{"guard.mode", "off"},  // what the controller does by itself
                    {"preset", preset},    {"track", "lakeside"},   {"laps", "2"},
                    {"latency_ms", "100"}, {"time_limit_s", "200"}, {"cubic_mpc.latency_handling", handling}};
  settings.insert(settings.end(), more.begin(), more.end());
  return drive(settings);
}

TEST(Latency, LeavesTheRoadWithoutCompensationAndRollForwardCuresIt) {
  for (const char* preset : {"weighted", "measured-latency", "fast-short-step"}) {
    EXPECT_GT(with_handling(preset, "none").off_track_events, 0) << preset;
    EXPECT_EQ(with_handling(preset, "roll-forward").off_track_events, 0) << preset;
    EXPECT_EQ(with_handling(preset, "measured").off_track_events, 0) << preset;
  }
}

TEST(Latency, IsNoTroubleWhereThereIsNone) {
  const auto run = with_handling("weighted", "none", {{"latency_ms", "0"}, {"control_period_ms", "20"}});
  EXPECT_TRUE(run.completed);
  EXPECT_EQ(run.off_track_events, 0);
}

TEST(Latency, MakesThePresetsThatSurviveItTrackWorse) {
  const auto error = [](const char* preset, const char* handling) {
    return with_handling(preset, handling).total.rms_lateral_error;
  };
  EXPECT_LT(error("sixty-mph", "position-only"), 0.6 * error("sixty-mph", "none"));
  EXPECT_LT(error("delay-in-model", "inside-model"), 0.85 * error("delay-in-model", "none"));
}

/// Two clean laps with `default`.
telemetry::RunSummary default_laps(const char* latency_ms, const char* period_ms, const Settings& more = {}) {
  return drive_cleanly({{"preset", "default"},
                        {"track", "lakeside"},
                        {"laps", "2"},
                        {"latency_ms", latency_ms},
                        {"control_period_ms", period_ms}},
                       more);
}

TEST(Latency, CostsTheDefaultControllerHardlyAnyTime) {
  const auto flying_lap = [](const char* latency_ms, const char* period_ms) {
    // The guard slows a car with three commands in a second.
    return default_laps(latency_ms, period_ms, {{"guard.mode", "off"}}).laps.at(1).lap_time;
  };
  EXPECT_LT(flying_lap("300", "320"), 1.03 * flying_lap("0", "20"));
}

TEST(Latency, KeepsTheDefaultControllerOnTheRoadWithTheGuardOn) {
  for (const auto& [latency, period] : {std::pair{"300", "320"}, {"0", "20"}, {"400", "40"}})
    default_laps(latency, period);
}

}  // namespace
}  // namespace chicane::run
