// SPDX-License-Identifier: MIT
#include "chicane/run/control_cycle.hpp"

#include "support/chicane_test.hpp"
#include "support/own_controller.hpp"
#include "support/runs.hpp"

namespace chicane::run {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

scenario::Scenario scenario_of(const char* preset) {
  return test::scenario_of({{"preset", preset}, {"laps", "1"}});
}

TEST(ControlCycle, DoesOutsideTheLoopWhatItDoesInsideAndStopsWhenNothingIsMeasured) {
  for (const char* preset : {"weighted", "pid", "default"}) {
    const scenario::Scenario scenario = scenario_of(preset);
    const auto loop = test::loop_of(scenario);
    ControlCycle alone(std::move(*make_controller(scenario)), scenario, &loop->track());
    const auto frame = std::make_unique<telemetry::Frame>();
    while (loop->time() < 20.0) {
      if (!loop->advance()) continue;
      frame->measurement = loop->frame().measurement;
      alone.step({.deadline = Deadline::never(), .interval = scenario.control_period}, *frame);
      ASSERT_EQ(frame->cycle, loop->frame().cycle);
      ASSERT_EQ(frame->begins, loop->frame().begins);
      ASSERT_EQ(frame->result.command.steer, loop->frame().result.command.steer) << preset << frame->cycle;
      ASSERT_EQ(frame->result.command.throttle, loop->frame().result.command.throttle);
      ASSERT_EQ(frame->guard.rung, loop->frame().guard.rung);
    }
    if (std::string_view(preset) != "default") continue;
    ASSERT_GT(frame->measurement.speed, 20.0);
    frame->measurement.x = frame->measurement.y = frame->measurement.psi = frame->measurement.speed = kNaN;
    frame->measurement.waypoint_count = 0;
    frame->has_measurement = false;
    double least = 1.0;
    for (int i = 0; i < 100; ++i) {
      frame->measurement.time += 0.04;
      alone.step({.interval = 0.04}, *frame);
      ASSERT_TRUE(std::isfinite(frame->result.command.steer));
      least = std::min(least, frame->result.command.throttle);
    }
    EXPECT_LT(least, 0.0) << "a car without commands stops";
  }
}

TEST(ControlCycle, CountsItsCyclesAndSaysWhereARunBegins) {
  const scenario::Scenario scenario = scenario_of("pid");
  ControlCycle cycle(std::move(*make_controller(scenario)), scenario, nullptr);
  const auto frame = std::make_unique<telemetry::Frame>();
  const auto step = [&] { cycle.step({.interval = 0.04}, *frame); };
  step();
  EXPECT_TRUE(frame->begins);
  EXPECT_EQ(frame->gate_interval, 0.0) << "before the first command there is none";
  step();
  EXPECT_FALSE(frame->begins);
  EXPECT_EQ(frame->cycle, 1U);
  EXPECT_EQ(frame->gate_interval, 0.04);
  EXPECT_EQ(frame->longest_interval, 0.04);
  cycle.begin(40, 0.42);
  step();
  EXPECT_EQ(frame->longest_interval, 0.42) << "of the link";
  EXPECT_TRUE(frame->begins);
  EXPECT_EQ(frame->cycle, 40U);
}

/// A user's controller may write any size; a model car's plan is brought to scale point by point.
class EndlessPlan final : public test::OwnController {
 public:
  EndlessPlan() : OwnController({0.0, 0.1}) { result_.plan.size = result_.plan.reference_size = 1'000'000; }
};

TEST(ControlCycle, KeepsAPlanOfAnySizeWithinItsCapacity) {
  const auto scenario = test::scenario_of({{"car", "f1tenth"}});
  ControlCycle cycle(std::make_unique<EndlessPlan>(), scenario, nullptr);
  const auto frame = std::make_unique<telemetry::Frame>();
  frame->measurement = {.x = 0.0, .y = 0.0, .psi = 0.0, .speed = 1.0};
  cycle.step({.interval = 0.04}, *frame);
  EXPECT_LE(frame->result.plan.size, controller::Plan::kCapacity);
  EXPECT_LE(frame->result.plan.reference_size, controller::Plan::kCapacity);
}

TEST(ControlCycle, SendsWhatAPersonWants) {
  const scenario::Scenario scenario = scenario_of("pid");
  ControlCycle cycle(std::move(*make_controller(scenario)), scenario, nullptr);
  const auto frame = std::make_unique<telemetry::Frame>();
  cycle.step({.manual = model::Command{.steer = 0.1, .throttle = 0.3}}, *frame);
  EXPECT_TRUE(frame->is_manual);
  EXPECT_EQ(frame->result.command.steer, 0.1);
  EXPECT_EQ(frame->manual.throttle, 0.3);
}

}  // namespace
}  // namespace chicane::run
