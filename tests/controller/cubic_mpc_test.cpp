// SPDX-License-Identifier: MIT
#include "chicane/controller/cubic_mpc.hpp"

#include "chicane/base/math.hpp"
#include "controller/every_controller.hpp"
#include "controller/sample_road.hpp"

namespace chicane::controller {
namespace {

const model::VehicleParams kCar;

std::unique_ptr<test::Guarded> make(const CubicMpcOptions& options) {
  auto controller = make_cubic_mpc(options, kCar);
  EXPECT_TRUE(controller.has_value()) << controller.error().message;
  return std::make_unique<test::Guarded>(std::move(*controller), kCar);
}

void expect_bounded(const StepResult& result) {
  ASSERT_TRUE(std::isfinite(result.command.steer) && std::isfinite(result.command.throttle));
  ASSERT_LE(std::fabs(result.command.steer), kCar.steer_limit);
  ASSERT_LE(std::fabs(result.command.throttle), 1.0);
}

TEST(CubicMpc, SolvesEveryVariantAndSteersBackToTheLine) {
  for (const auto& options : cubic_variants()) {
    const auto controller = make(options);
    const test::Sent& result = controller->step(on_a_left_bend(), Deadline::never());
    EXPECT_EQ(result.report.solve.status, solver::SolveStatus::kOptimal);
    EXPECT_EQ(result.guard.rung, Rung::kController);
    expect_bounded(result);
    EXPECT_LT(result.command.steer,
              0.06);  // 80 m ask for 0.033 rad; half a metre left of the line, less than that
    EXPECT_NEAR(result.report.lateral_error, 0.5, 0.06);  // least squares miss 60 m of the circle by 4.5 cm
    EXPECT_NEAR(result.report.heading_error, 0.0, 0.01);
  }
}

TEST(CubicMpc, HasTheSameAnswerWithBothSteeringSigns) {
  CubicMpcOptions options;
  const model::Command ours = make(options)->step(on_a_left_bend(), Deadline::never()).command;
  options.steering_right_positive = true;
  const model::Command simulators = make(options)->step(on_a_left_bend(), Deadline::never()).command;
  EXPECT_NEAR(ours.steer, simulators.steer, 1e-6);
  EXPECT_NEAR(ours.throttle, simulators.throttle, 1e-6);
}

TEST(CubicMpc, PlansInTheWorldFromWhereTheCommandActs) {
  CubicMpcOptions options;
  options.latency_handling = LatencyHandling::kPositionOnly;
  const model::Measurement now = on_a_left_bend(10.0, 20.0, 0.5 * kPi);
  const auto controller = make(options);
  const Plan& plan = controller->step(now, Deadline::never()).plan;
  ASSERT_EQ(plan.size, options.horizon_steps);
  EXPECT_NEAR(plan.points[0].time, now.time + 0.1, 1e-12);
  EXPECT_NEAR(plan.points[0].x, 10.0, 1e-9);
  EXPECT_NEAR(plan.points[0].y, 20.0 + 1.5, 1e-9);
  EXPECT_NEAR(plan.points[1].time - plan.points[0].time, options.step_length, 1e-12);
  EXPECT_GT(plan.points[9].y, 30.0);
  EXPECT_LT(plan.points[9].x, 10.0);  // the road bends left
  ASSERT_GT(plan.reference_size, 2);
  EXPECT_NEAR(plan.reference[0].x(), 10.5, 0.08);  // the line is half a metre to the right
}

TEST(CubicMpc, PutsALateInputBesideTheStateItMeets) {
  CubicMpcOptions options;
  options.latency_handling = LatencyHandling::kInsideModel;
  const model::Measurement now = on_a_left_bend();
  const auto controller = make(options);
  const test::Sent& result = controller->step(now, Deadline::never());
  EXPECT_EQ(result.plan.size, options.horizon_steps - 1);
  EXPECT_NEAR(result.plan.points[0].time, now.time + options.step_length, 1e-12);
  EXPECT_EQ(result.plan.points[0].command.steer, result.command.steer);
  // The first stage is driven by the wheel as measured, equation (13).
  EXPECT_NEAR(result.plan.points[0].psi, now.speed * now.steer / kCar.kinematic_length * options.step_length,
              1e-9);
}

TEST(CubicMpc, SlowsForTurnsWhenSpeedTimesSteeringCosts) {
  CubicMpcOptions options;
  options.speed_reference = 15.0;
  const double without = make(options)->step(on_a_left_bend(), Deadline::never()).command.throttle;
  options.weight_speed_steer = 50.0;
  EXPECT_LT(make(options)->step(on_a_left_bend(), Deadline::never()).command.throttle, without);
}

TEST(CubicMpc, SeesFartherAndSteersLessWithTheSpeedInMilesPerHour) {
  CubicMpcOptions options;
  options.speed_reference = 15.0;
  const auto metres = make(options);
  options.speed_in_mph = true;
  const auto miles = make(options);
  model::Measurement now = on_a_left_bend();
  now.psi = -0.1;  // heading off the road to the right: both steer back
  const StepResult& a = metres->step(now, Deadline::never());
  const StepResult& b = miles->step(now, Deadline::never());
  EXPECT_GT(b.command.steer, 0.0);
  EXPECT_LT(b.command.steer, a.command.steer);
  EXPECT_NEAR(b.plan.points[0].speed, a.plan.points[0].speed, 1e-9);  // reported in m/s all the same
  EXPECT_EQ(b.report.speed_reference, 15.0);
  const auto reach = [](const Plan& plan) { return plan.points[1].x - plan.points[0].x; };
  EXPECT_NEAR(reach(b.plan) / reach(a.plan), 2.2369, 1e-3);
}

TEST(CubicMpc, UsesTheLastPlanOnceTheLineIsLostAndRecoversWithIt) {
  const auto controller = make(CubicMpcOptions{});
  model::Measurement now = on_a_left_bend();
  ASSERT_EQ(controller->step(now, Deadline::never()).guard.rung, Rung::kController);
  const double second = controller->step(now, Deadline::never()).plan.points[1].command.steer;
  now.waypoint_count = 0;
  now.time += 0.1;
  const test::Sent& lost = controller->step(now, Deadline::never());
  EXPECT_EQ(lost.guard.rung, Rung::kShiftedPlan);
  EXPECT_DOUBLE_EQ(lost.command.steer, second);
  now.time += 0.6;
  EXPECT_EQ(controller->step(now, Deadline::never()).guard.rung, Rung::kHoldAndBrake);
  now.time += 2.0;
  EXPECT_EQ(controller->step(now, Deadline::never()).guard.rung, Rung::kBrake);
  now.waypoint_count = 6;
  EXPECT_EQ(controller->step(now, Deadline::never()).guard.rung, Rung::kController);
}

TEST(CubicMpc, TakesTheRungThatTheStatusAsksFor) {
  const Deadline spent = Deadline::after(std::chrono::nanoseconds{0});
  const auto controller = make(CubicMpcOptions{});
  model::Measurement now = on_a_left_bend();

  const test::Sent& result = controller->step(now, spent);  // cold and out of time: nothing near an optimum
  EXPECT_EQ(result.report.solve.status, solver::SolveStatus::kStalled);
  EXPECT_EQ(result.guard.rung, Rung::kHoldAndBrake);
  expect_bounded(result);

  (void)controller->step(now, Deadline::never());
  EXPECT_EQ(result.report.solve.status, solver::SolveStatus::kOptimal);
  EXPECT_EQ(result.guard.rung, Rung::kController);

  now.speed += 1e-6;  // the optimum of almost the same problem is good enough
  (void)controller->step(now, spent);
  EXPECT_EQ(result.report.solve.status, solver::SolveStatus::kBudgetSpent);
  EXPECT_EQ(result.guard.rung, Rung::kController);

  now.speed = 1e300;
  (void)controller->step(now, Deadline::never());
  EXPECT_EQ(result.report.solve.status, solver::SolveStatus::kNotFinite);
  EXPECT_EQ(result.guard.rung, Rung::kShiftedPlan);
  expect_bounded(result);
  // kInfeasible needs a soft constraint, and this problem has none.
}

TEST(CubicMpc, TakesTheLongestHorizon) {
  CubicMpcOptions options;
  options.horizon_steps = 200;
  options.step_length = 0.02;
  const auto controller = make(options);
  const test::Sent& result = controller->step(on_a_left_bend(), Deadline::never());
  expect_bounded(result);
  EXPECT_EQ(result.guard.rung, Rung::kController);
  EXPECT_EQ(result.plan.size, 200);
}

TEST(CubicMpc, SaysWhichOptionIsMissingBesideAnother) {
  CubicMpcOptions options{.heading_error_integrated = false, .lateral_error_integrated = true};
  const std::vector<OptionContradiction> found = CubicMpcEntry::contradictions(options);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].option, "lateral_error_integrated");
  EXPECT_NE(found[0].message.find("got true, expected cubic_mpc.heading_error_integrated=true beside it"),
            std::string::npos)
      << found[0].message;
  options.heading_error_integrated = true;
  EXPECT_TRUE(CubicMpcEntry::contradictions(options).empty());
}

}  // namespace
}  // namespace chicane::controller
