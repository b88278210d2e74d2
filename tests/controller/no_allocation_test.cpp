// SPDX-License-Identifier: MIT

#include "chicane/controller/baselines.hpp"
#include "chicane/controller/cubic_mpc.hpp"
#include "chicane/controller/tracking_mpc.hpp"
#include "controller/sample_road.hpp"
#include "support/alloc_guard.hpp"
#include "support/chicane_test.hpp"
#include "support/guarded.hpp"

namespace chicane::controller {
namespace {

std::vector<std::unique_ptr<test::Guarded>> all_controllers() {
  const model::VehicleParams car;
  std::vector<std::unique_ptr<test::Guarded>> all;
  all.push_back(std::make_unique<test::Guarded>(std::move(*make_pid({}, car)), car));
  all.push_back(std::make_unique<test::Guarded>(std::move(*make_pure_pursuit({}, car)), car));
  all.push_back(std::make_unique<test::Guarded>(std::move(*make_stanley({}, car)), car));
  all.push_back(std::make_unique<test::Guarded>(std::move(*make_tracking_mpc({}, car)), car));
  for (const auto handling :
       {LatencyHandling::kNone, LatencyHandling::kRollForward, LatencyHandling::kMeasured,
        LatencyHandling::kPositionOnly, LatencyHandling::kInsideModel}) {
    CubicMpcOptions options;
    options.latency_handling = handling;
    options.polar_waypoints = handling == LatencyHandling::kMeasured;
    all.push_back(std::make_unique<test::Guarded>(std::move(*make_cubic_mpc(options, car)), car));
  }
  return all;
}

TEST(Controllers, AllocateNothingInAStep) {
  for (const auto& controller : all_controllers()) {
    model::Measurement now = on_a_left_bend();
    const test::AllocationGuard guard;
    for (int i = 0; i < 100; ++i) {
      now.time += 0.1;
      now.psi += 0.001;
      if (i % 10 == 9) now.waypoint_count = 0;  // the fallback ladder, too
      if (i % 10 == 5) now.x = std::numeric_limits<double>::quiet_NaN();
      (void)controller->step(now, Deadline::never());
      now.waypoint_count = 6;
      now.x = 0.01 * i;
    }
    EXPECT_EQ(guard.count(), 0) << controller->name();
  }
}

}  // namespace
}  // namespace chicane::controller
