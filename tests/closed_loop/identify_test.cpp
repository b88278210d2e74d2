// SPDX-License-Identifier: MIT
// Cars that are otherwise than told, identified while they drive (docs/identification.md, "During a run").
#include <gtest/gtest.h>

#include <cmath>

#include "closed_loop/drive.hpp"

namespace chicane::run {
namespace {

/// One lap of lakeside with commands that act `delay` [s] and wheels that stand `offset` [deg] off what is
/// told.
telemetry::RunSummary identified(const char* car, double delay, double offset, const Settings& more = {}) {
  Settings settings{{"car", car}, {"laps", "1"}, {"identify.during_run", "true"}};
  settings.insert(settings.end(), more.begin(), more.end());
  auto scenario = protocol::compose({.scenario_file = "", .settings = settings});
  EXPECT_TRUE(scenario);
  const auto add = [&](const char* fault, double strength) {
    scenario->faults.push_back({*sim::fault_named(fault), 0.0, 1000.0, strength});
  };
  if (delay > 0.0) add("delay_doubled", 1.0 + delay / scenario->latency);
  if (offset != 0.0) add("steering_offset", offset);
  const auto loop = run::ClosedLoop::create(*scenario);
  EXPECT_TRUE(loop);
  return run::run_closed_loop(**loop);
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

TEST(IdentifyDuringRun, IsOffUnlessAskedFor) {
  const telemetry::RunSummary run = identified("road-car", 0.0, 0.0, {{"identify.during_run", "false"}});
  EXPECT_TRUE(std::isnan(run.learned.delay.value));
}

}  // namespace
}  // namespace chicane::run
