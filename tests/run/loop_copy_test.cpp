// SPDX-License-Identifier: MIT
// Copies of a run: ClosedLoop::copy(), and copy() of all that it is made of.

#include "chicane/controller/controller.hpp"
#include "chicane/run/run_steps.hpp"
#include "support/chicane_test.hpp"
#include "support/own_controller.hpp"
#include "support/runs.hpp"

namespace chicane::run {
namespace {

using test::Settings;

std::unique_ptr<ClosedLoop> loop_of(Settings settings) {
  settings.insert(settings.begin(), {{"laps", "0"}, {"sensor.position_noise_m", "0.02"}});
  return test::loop_of(test::scenario_of(settings));
}

void drive(ClosedLoop& loop, double seconds) {
  const double end = loop.time() + seconds;
  while (loop.time() < end) loop.advance();
}

/// Every number that the car and its controller come to from now on, step by step.
std::vector<double> future_of(ClosedLoop& loop, double seconds) {
  std::vector<double> all;
  const double end = loop.time() + seconds;
  while (loop.time() < end) {
    if (!loop.advance()) continue;
    const telemetry::Frame& frame = loop.frame();
    all.insert(all.end(), {frame.time, frame.truth.x, frame.truth.y, frame.truth.psi, frame.measurement.x,
                           frame.result.command.steer, frame.result.command.throttle, frame.applied.steer,
                           frame.lateral_error, frame.edge_distance, static_cast<double>(frame.lap),
                           static_cast<double>(frame.active_faults), frame.result.plan.points[1].x});
  }
  return all;
}

void expect_same(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) && std::isnan(b[i])) continue;
    ASSERT_EQ(a[i], b[i]) << "number " << i % 13 << " of control step " << i / 13;
  }
}

struct Case {
  const char* name;
  Settings settings;
};

class Copied : public testing::TestWithParam<Case> {};

TEST_P(Copied, GoesOnLikeTheRunToTheLastBitAndLeavesItAlone) {
  const auto run = loop_of(GetParam().settings);
  // From standstill, in the first lap while the road is being learned, and at the line while it is planned
  // anew.
  for (const double wait : {0.1, 3.0, 12.0, 12.0, 4.0}) {
    drive(*run, wait);
    SCOPED_TRACE(run->time());
    auto first = run->copy();
    auto second = first->copy();
    const auto was = future_of(*first, 3.0);
    first.reset();  // what the second one still asked of it would be gone
    drive(*run, 0.5);
    expect_same(future_of(*second, 3.0), was);
  }
  // The run itself is not touched by any of it.
  const auto alone = loop_of(GetParam().settings);
  while (alone->time() < run->time()) alone->advance();
  expect_same(future_of(*run, 3.0), future_of(*alone, 3.0));
}

INSTANTIATE_TEST_SUITE_P(
    Runs, Copied,
    testing::Values(Case{"default", {}}, Case{"road_car", {{"car", "road-car"}}},
                    Case{"race", {{"preset", "race"}}},
                    Case{"race_from_waypoints",
                         {{"preset", "race"}, {"guard.road", "waypoints"}, {"track", "oval"}}},
                    Case{"model_car", {{"car", "f1tenth"}}},
                    Case{"cubic_mpc", {{"controller", "cubic-mpc"}, {"track", "oval"}}},
                    Case{"pid", {{"controller", "pid"}, {"track", "oval"}}},
                    Case{"pure_pursuit", {{"controller", "pure-pursuit"}, {"track", "oval"}}},
                    Case{"stanley", {{"controller", "stanley"}, {"track", "oval"}}},
                    Case{"learns_grip", {{"preset", "race"}, {"tracking_mpc.learn_grip", "true"}}}),
    [](const auto& each) { return std::string(each.param.name); });

TEST(Copy, KeepsFaultsThatAct) {
  const auto run = loop_of({{"track", "oval"}});
  drive(*run, 8.0);
  run->set_fault("half_grip", true);
  drive(*run, 0.4);
  const auto copy = run->copy();
  EXPECT_NE(copy->frame().active_faults, 0U);
  expect_same(future_of(*copy, 5.0), future_of(*run, 5.0));
}

/// A lap that is wanted, and not there yet, comes at the same time.
TEST(Copy, OfStepsGetsTheSamePlan) {
  const auto run = loop_of({{"preset", "race"}, {"guard.road", "waypoints"}, {"track", "oval"}});
  std::vector<double> changes;
  const RunHooks hooks{.on_change = [&](const telemetry::Change& change) { changes.push_back(change.time); }};
  RunSteps steps(*run, hooks);
  double wanted = 0.0;
  while (run->time() < wanted + 0.5 * LapPlanner::kPlanningTime || wanted == 0.0) {
    steps.advance();
    if (wanted == 0.0 && run->controller().wants_lap().is_wanted) wanted = run->time();
  }
  ASSERT_THAT(changes, IsEmpty());
  const auto copy = run->copy();
  RunSteps copied(*copy, steps);
  const auto drive_to_plan = [&](RunSteps& each, std::size_t count) {
    while (changes.size() < count && each.loop().time() < wanted + 60.0) each.advance();
  };
  drive_to_plan(steps, 1);
  drive_to_plan(copied, 2);
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_EQ(changes[0], changes[1]);
}

TEST(Copy, IsNoneOfAControllerThatCannotBeCopied) {
  const auto loop = ClosedLoop::create(test::scenario_of({{"track", "oval"}}), test::make_own_controller);
  ASSERT_TRUE(loop);
  EXPECT_EQ((*loop)->copy(), nullptr);
  EXPECT_EQ(controller::copy_of((*loop)->controller()), nullptr);
}

}  // namespace
}  // namespace chicane::run
