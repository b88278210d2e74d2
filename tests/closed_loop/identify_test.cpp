// SPDX-License-Identifier: MIT
// Cars that are otherwise than told, identified while they drive (docs/identification.md, "During a run").

#include "closed_loop/drive.hpp"

namespace chicane::run {
namespace {

/// One lap of lakeside with commands that act `delay` [s] and wheels that stand `offset` [deg] off what is
/// told.
telemetry::RunSummary identified(const char* car, double delay, double offset, const Settings& more = {}) {
  Settings settings{{"car", car}, {"laps", "1"}};
  settings.insert(settings.end(), more.begin(), more.end());
  scenario::Scenario scenario = test::scenario_of(settings);
  const auto add = [&](const char* fault, double strength) {
    scenario.faults.push_back({*sim::fault_named(fault), 0.0, 1000.0, strength});
  };
  if (delay > 0.0) add("delay_doubled", 1.0 + delay / scenario.latency);
  if (offset != 0.0) add("steering_offset", offset);
  return test::drive(scenario);
}

TEST(IdentifyDuringRun, FindsDelayAndOffsetWithinALap) {
  for (const char* car : {"road-car", "udacity"}) {
    const telemetry::RunSummary run = identified(car, 0.06, 2.0, {{"plant_options.friction_scale", "0.85"}});
    EXPECT_TRUE(completed_on_road(run)) << car;
    EXPECT_NEAR(run.learned.delay.value, 0.06, 0.02) << car;
    EXPECT_LT(run.learned.delay.deviation, 0.02) << car;
    EXPECT_NEAR(run.learned.offset.value, degrees_to_radians(2.0), degrees_to_radians(0.4)) << car;
    EXPECT_LT(run.learned.offset.deviation, degrees_to_radians(0.3)) << car;
  }
}

TEST(IdentifyDuringRun, LeavesACarThatIsAsToldAlone) {
  for (const char* car : {"road-car", "udacity"}) {
    const telemetry::RunSummary run = identified(car, 0.0, 0.0);
    EXPECT_TRUE(completed_on_road(run)) << car;
    EXPECT_NEAR(run.learned.delay.value, 0.0, 0.02) << car;
    EXPECT_NEAR(run.learned.offset.value, 0.0, degrees_to_radians(0.3)) << car;
    EXPECT_NEAR(run.learned.gain.value, 1.0, 0.1) << car;
  }
}

/// A tenth less grip, measurements 30 ms old and wheels half a degree off, with the noise of a good satellite
/// receiver: nothing of it is configured.
TEST(IdentifyDuringRun, RacesACarThatIsALittleOtherwise) {
  for (const char* track : {"original-lake", "lakeside", "hairpins"}) {
    if (!kDrivesAll && std::string(track) != "original-lake") break;
    for (const double offset : {-0.5, 0.5}) {
      if (!kDrivesAll && offset > 0.0) break;
      const telemetry::RunSummary run = identified("udacity", 0.0, offset,
                                                   {{"preset", "race"},
                                                    {"track", track},
                                                    {"laps", "4"},
                                                    {"seed", "17"},
                                                    {"plant_options.friction_scale", "0.9"},
                                                    {"sensor.latency_ms", "30"},
                                                    {"sensor.position_noise_m", "0.05"},
                                                    {"sensor.heading_noise_deg", "0.3"},
                                                    {"sensor.speed_noise_mps", "0.1"}});
      EXPECT_TRUE(completed_on_road(run)) << track << ' ' << offset;
      EXPECT_GT(run.total.min_edge_distance, 0.05) << track << ' ' << offset;
    }
  }
}

TEST(IdentifyDuringRun, HoldsInEachModeOfTheGuardAndForEachController) {
  for (const char* preset : {"default", "pid"})
    for (const char* mode : {"on", "observe", "off"})
      for (const double side : {-1.0, 1.0}) {
        const bool is_turn = (side > 0.0) == (mode == std::string_view("on"));
        if (!kDrivesAll && !is_turn) continue;
        const telemetry::RunSummary run =
            identified("road-car", 0.0, 2.0 * side,
                       {{"preset", preset}, {"guard.mode", mode}, {"track", "oval"}, {"time_limit_s", "20"}});
        EXPECT_NEAR(run.learned.offset.value, side * degrees_to_radians(2.0), degrees_to_radians(0.4))
            << preset << ' ' << mode << ' ' << side;
      }
}

}  // namespace
}  // namespace chicane::run
