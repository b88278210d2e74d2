// SPDX-License-Identifier: MIT
#include "controller/every_controller.hpp"

#include "controller/sample_road.hpp"
#include "support/alloc_guard.hpp"

namespace chicane::controller {
namespace {

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

/// The answer after a few cycles in which the car stands still in `now`'s world.
test::Sent answer_to(test::Guarded& controller, model::Measurement now) {
  controller.reset();
  for (int i = 0; i < 5; ++i, now.time += 0.001) (void)controller.step(now, Deadline::never());
  return controller.step(now, Deadline::never());
}

TEST(Controllers, MirrorWithTheWorldDoNotCareWhereTheyDriveAndForgetOnReset) {
  for (const auto& controller : all_controllers()) {
    SCOPED_TRACE(controller->name());
    const test::Sent here = answer_to(*controller, on_a_left_bend());
    const test::Sent mirror = answer_to(*controller, mirrored(on_a_left_bend()));
    const test::Sent there = answer_to(*controller, on_a_left_bend(-321.0, 99.0, 2.5));
    const double close = controller->name() == "cubic-mpc" ? 1e-6 : 1e-9;  // the solver's tolerance
    EXPECT_NEAR(here.command.steer, -mirror.command.steer, close);
    EXPECT_NEAR(here.command.throttle, mirror.command.throttle, close);
    EXPECT_NEAR(here.report.lateral_error, -mirror.report.lateral_error, close);
    EXPECT_NEAR(here.command.steer, there.command.steer, 1e-6);  // projection onto a spline stops at 1e-8 m
    EXPECT_NEAR(here.command.throttle, there.command.throttle, 1e-6);
    EXPECT_EQ(here.command, answer_to(*controller, on_a_left_bend()).command) << "bit for bit";
  }
}

/// Measurements with one thing in each that no sensor says.
std::vector<model::Measurement> hostile_measurements() {
  using M = model::Measurement;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<M> all;
  for (const double value : {std::nan(""), kInfinity, -1e308, 1e300, 1e9, 0.0}) {
    for (double M::*field : {&M::x, &M::psi, &M::speed, &M::time, &M::steer, &M::delay}) {
      all.push_back(on_a_left_bend());
      all.back().*field = value;
    }
    all.push_back(on_a_left_bend());
    all.back().waypoints.fill({value, value});
  }
  for (const int count : {-3, 0, 1, 1'000'000}) {
    all.push_back(on_a_left_bend());
    all.back().waypoint_count = count;
  }
  return all;
}

TEST(Controllers, AnswerWithABoundedCommandWhateverIsMeasured) {
  const std::vector<model::Measurement> hostile = hostile_measurements();
  for (const auto& controller : all_controllers()) {
    SCOPED_TRACE(controller->name());
    for (const model::Measurement& now : hostile) {
      const test::Sent& result = controller->step(now, Deadline::never());
      ASSERT_TRUE(std::isfinite(result.command.steer) && std::isfinite(result.command.throttle));
      ASSERT_LE(std::fabs(result.command.steer), model::VehicleParams{}.steer_limit);
      ASSERT_LE(std::fabs(result.command.throttle), 1.0);
      const bool is_usable = now.is_finite() && std::isfinite(now.time) && now.waypoint_count > 1;
      if (controller->name() == "tracking-mpc") continue;  // drives on by what it remembers
      EXPECT_TRUE(is_usable || result.guard.rung != Rung::kController) << &now - hostile.data();
    }
    model::Measurement good = on_a_left_bend();
    for (int i = 0; i < 4; ++i) {
      good.time = 1e3 + 0.05 * i;
      (void)controller->step(good, Deadline::never());
    }
    EXPECT_EQ(controller->step(good, Deadline::never()).guard.rung, Rung::kController)
        << "no poison stays behind";
    EXPECT_EQ(answer_to(*controller, on_a_left_bend()).guard.rung, Rung::kController);
  }
}

}  // namespace
}  // namespace chicane::controller
