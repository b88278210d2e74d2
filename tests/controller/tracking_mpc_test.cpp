// SPDX-License-Identifier: MIT
#include "chicane/controller/tracking_mpc.hpp"

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "controller/sample_road.hpp"
#include "support/chicane_test.hpp"
#include "support/guarded.hpp"

namespace chicane::controller {
namespace {

std::unique_ptr<test::Guarded> make(const TrackingMpcOptions& options = {}) {
  return std::make_unique<test::Guarded>(std::move(*make_tracking_mpc(options, model::udacity_params())),
                                         model::udacity_params());
}

/// The command after a few cycles in which the car stands still in `now`'s world.
test::Sent after_cycles(model::Measurement now, int cycles = 5) {
  const auto controller = make();
  test::Sent result;
  for (int i = 0; i < cycles; ++i) {
    result = controller->step(now, Deadline::never());
    now.time += 0.001;
  }
  return result;
}

TEST(TrackingMpc, SteersBackToTheLineAndPlansAhead) {
  const test::Sent result = after_cycles(on_a_left_bend());
  EXPECT_EQ(result.guard.rung, Rung::kController);
  EXPECT_GT(result.report.sight, 40.0);
  ASSERT_EQ(result.plan.size, TrackingMpcOptions{}.horizon_steps + 1);
  EXPECT_NEAR(result.plan.points[0].time, 5.004 + 0.1, 1e-9) << "the plan begins when the command acts";
  EXPECT_NEAR(hypot(result.plan.points[0].x, result.plan.points[0].y), 15.0 * 0.1, 0.2);
}

/// The last answer is only a first guess: what the road asks is what is seen now.
TEST(TrackingMpc, SteersByTheRoadThatItSeesNow) {
  const auto controller = make();
  model::Measurement now = on_a_left_bend();
  for (int i = 0; i < 5; ++i, now.time += 0.001) controller->step(now, Deadline::never());
  model::Measurement right = mirrored(on_a_left_bend());
  right.time = now.time;
  for (int i = 0; i < 20; ++i, right.time += 0.001) controller->step(right, Deadline::never());
  const StepResult changed = controller->step(right, Deadline::never());
  const StepResult as_always = after_cycles(mirrored(on_a_left_bend()), 21);
  EXPECT_NEAR(changed.command.steer, as_always.command.steer, 1e-3);
  EXPECT_LT(changed.command.steer, -0.01);
}

TEST(TrackingMpc, TurnsRoundAfterASpinAndDrivesOn) {
  const auto controller = make();
  const double wheelbase = model::udacity_params().wheelbase();
  model::Measurement now;
  now.x = 40.0;
  now.y = 3.0;
  now.psi = 2.6;  // nearly backwards on a straight road along x
  double speed = 0.0;
  for (int i = 0; i < 500; ++i) {
    now.time = 0.05 * i;
    now.speed = speed;
    now.waypoint_count = 6;
    for (int j = 0; j < 6; ++j)
      now.waypoints[static_cast<std::size_t>(j)] = {12.0 * (std::floor(now.x / 12.0) + j), 0.0};
    const model::Command command = controller->step(now, Deadline::never()).command;
    speed = std::max(
        0.0, speed + 0.05 * longitudinal_acceleration(model::udacity_params(), command.throttle, speed));
    now.psi += 0.05 * speed * std::tan(command.steer) / wheelbase;
    now.x += 0.05 * speed * std::cos(now.psi);
    now.y += 0.05 * speed * std::sin(now.psi);
    if (std::fabs(angle_difference(now.psi, 0.0)) < 0.1 && speed > 8.0) return;
    ASSERT_LT(std::fabs(now.y), 20.0) << "it does not wander off";
  }
  FAIL() << "still at " << speed << " m/s and " << now.psi << " rad";
}

TEST(TrackingMpc, AMissedDeadlineStillGivesACommand) {
  const auto controller = make();
  model::Measurement now = on_a_left_bend();
  for (int i = 0; i < 20; ++i) {
    now.time += 0.04;
    const test::Sent& result = controller->step(now, Deadline::after(std::chrono::nanoseconds(0)));
    EXPECT_LE(std::fabs(result.command.steer), model::udacity_params().steer_limit);
    EXPECT_LE(result.report.solve.iterations, 1);
  }
}

}  // namespace
}  // namespace chicane::controller
