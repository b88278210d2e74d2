// SPDX-License-Identifier: MIT
#include "chicane/safety/guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "chicane/base/random.hpp"
#include "support/alloc_guard.hpp"
#include "support/borrowed.hpp"
#include "support/guarded.hpp"

namespace chicane::safety {
namespace {

using controller::Answer;
using controller::Rung;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

model::VehicleParams car() {
  model::VehicleParams car;
  car.steer_limit = 0.4;
  car.steer_rate_limit = 1.0;
  return car;
}

/// Answers as it is told to, and remembers what it was given.
class Scripted final : public controller::Controller {
 public:
  const controller::StepResult& step(const model::Measurement& now, Deadline) noexcept override {
    seen = now;
    return result;
  }
  void note_sent(const model::Command& command) noexcept override { sent.push_back(command); }
  void reset() noexcept override { ++resets; }
  [[nodiscard]] std::string_view name() const noexcept override { return "scripted"; }

  controller::StepResult result;
  model::Measurement seen;
  std::vector<model::Command> sent;
  int resets = 0;
};

model::Measurement at(double time, double speed = 20.0) {
  model::Measurement now;
  now.time = time;
  now.x = speed * time;
  now.speed = speed;
  now.delay = 0.1;
  return now;
}

class GuardTest : public ::testing::Test {
 protected:
  GuardTest() : guard_{std::make_unique<test::Borrowed>(scripted_), car()} { scripted_.sent.reserve(1000); }
  const test::Sent& step(const model::Measurement& now, const Guard::Cycle& cycle = {}) {
    asked_ = guard_.step(now, Deadline::never(), cycle, result_);
    result_.guard = guard_.report();
    return result_;
  }

  Scripted scripted_;
  Guard guard_;
  test::Sent result_;
  model::Command asked_;
};

/// `intervals` of 4 m, 10 m wide.
road::RoadData straight_road(int intervals) {
  road::RoadData road;
  road.length = 4.0 * intervals;
  for (int i = 0; i <= intervals; ++i)
    road.points.push_back({.s = 4.0 * i, .position = {4.0 * i, 0.0}, .left = 5.0, .right = 5.0});
  return road;
}

TEST_F(GuardTest, BeginsAControllerAnewThatHasNoAnswerToWholeMeasurements) {
  scripted_.result.answer = Answer::kNone;
  const int before = scripted_.resets;
  for (int i = 0; i <= 60; ++i) step(at(1000.0 + 0.04 * i));
  EXPECT_EQ(scripted_.resets - before, 2);
  for (int i = 61; i <= 120; ++i) {
    model::Measurement blind = at(1000.0 + 0.04 * i);
    blind.x = kNaN;
    step(blind);
  }
  EXPECT_EQ(scripted_.resets - before, 2) << "nothing to answer";
}

TEST_F(GuardTest, AcceptsThePlaceToWhichAPersonHasDriven) {
  scripted_.result.command = {0.0, 0.2};
  const auto elsewhere = [](int i) {
    model::Measurement now = at(0.04 * i);
    now.y = 70.0;
    return now;
  };
  for (int i = 0; i < 60; ++i) step(at(0.04 * i));
  for (int i = 60; i < 70; ++i) step(elsewhere(i));
  EXPECT_EQ(result_.guard.reason, controller::GuardReason::kPositionJump);
  for (int i = 70; i < 80; ++i) step(elsewhere(i), {.interval = 0.04, .manual = model::Command{0.0, 0.2}});
  for (int i = 80; i < 90; ++i) step(elsewhere(i));
  EXPECT_NE(result_.guard.reason, controller::GuardReason::kPositionJump);
}

/// A car that stands although it should move has a sentence and a way out: its pedals are released now and
/// then, more often where a brake is known to stay on.
TEST(GuardOfAStuckCar, NamesItAndReleasesItsPedals) {
  for (const bool latches : {false, true}) {
    model::VehicleParams vehicle = car();
    vehicle.brake_latch_speed = latches ? 0.5 : 0.0;
    const double release = latches ? vehicle.brake_release_throttle : 0.0;
    Scripted scripted;
    scripted.result.command = {.steer = 0.0, .throttle = 0.5};
    Guard guard{std::make_unique<test::Borrowed>(scripted), vehicle};
    controller::StepResult sent;
    const auto step = [&](double time, double speed) {
      const model::Measurement seen{.time = time, .x = 7.0, .speed = speed, .delay = 0.1};
      guard.step(seen, Deadline::never(), {.interval = 0.04}, sent);
      return guard.report().reason == controller::GuardReason::kStuck;
    };
    int released = 0;
    for (int i = 0; i <= 250; ++i) {
      const double time = 1000.0 + 0.04 * i;
      EXPECT_EQ(step(time, 0.0), 0.04 * i > 3.0 + 1e-6) << i;
      released += sent.command.throttle == release ? 1 : 0;
    }
    EXPECT_EQ(released, latches ? 19 : 3);
    scripted.result.command.throttle = 0.0;
    EXPECT_FALSE(step(1010.04, 0.0)) << "need not move";
    scripted.result.command.throttle = 0.5;
    EXPECT_FALSE(step(1010.08, 0.0)) << "counts anew";
  }
}

TEST_F(GuardTest, PassesAnAnswerOnUnchanged) {
  scripted_.result.command = {.steer = 0.123, .throttle = 0.456};
  const test::Sent& result = step(at(1.0));
  EXPECT_EQ(result.command.steer, 0.123);
  EXPECT_EQ(result.command.throttle, 0.456);
  EXPECT_EQ(result.guard.rung, Rung::kController);
  EXPECT_FALSE(result.guard.gated);
}

TEST_F(GuardTest, SaysWhichAnswerWithoutAPlanWasGiven) {
  scripted_.result.answer = Answer::kReturnToRoad;
  EXPECT_EQ(step(at(1.0)).guard.rung, Rung::kReturnToRoad);
  scripted_.result.answer = Answer::kStopOnRoad;
  EXPECT_EQ(step(at(1.04)).guard.rung, Rung::kStopOnRoad);
}

/// Where the tyres of a car are 0.1 m inside the left edge of straight_road() [m].
double beside_the_edge(const model::VehicleParams& vehicle) {
  return 4.9 - 0.5 * (vehicle.track_width + vehicle.tire_width);
}

/// A way back is slow: whoever calls a fast drive one is checked like everybody.
TEST(GuardOnARoad, RefusesAWayBackThatIsFast) {
  const road::RoadData straight = straight_road(100);
  Scripted scripted;
  Guard guard{std::make_unique<test::Borrowed>(scripted), car(), {}, &straight};
  scripted.result.answer = Answer::kReturnToRoad;
  controller::StepResult result;
  const auto rung_at = [&](double speed) {
    guard.reset();
    scripted.result.command = {.steer = 0.4, .throttle = 1.0};
    for (int i = 1; i < 8; ++i) {
      model::Measurement now = at(0.04 * i, speed);
      now.x += 100.0;
      now.y = speed > 5.0 ? beside_the_edge(car()) : 0.0;  // that the wheel points to
      guard.step(now, Deadline::never(), {.interval = 0.04}, result);
    }
    return guard.report().rung;
  };
  EXPECT_EQ(rung_at(20.0), Rung::kGuardStop);
  EXPECT_EQ(guard.report().reason, controller::GuardReason::kNoWayToStop);
  EXPECT_EQ(rung_at(2.0), Rung::kReturnToRoad);
}

/// On a straight road at `speed`, the command that is sent for what the controller asks in each of 8 cycles.
model::Command sent_at(double speed, Answer answer, const model::Command& asked, test::Sent& result,
                       double y = 0.0) {
  const road::RoadData straight = straight_road(100);
  Scripted scripted;
  Guard guard{std::make_unique<test::Borrowed>(scripted), model::udacity_params(), {}, &straight};
  for (int i = 1; i < 8; ++i) {
    scripted.result.answer = answer;
    scripted.result.command = i < 3 ? model::Command{} : asked;
    model::Measurement now = at(0.04 * i, speed);
    now.x += 100.0;
    now.y = y;
    guard.step(now, Deadline::never(), {.interval = 0.04}, result);
    result.guard = guard.report();
  }
  return result.command;
}

/// Every kind of answer is checked, as the actuators would carry it out.
TEST(GuardOnARoad, ChecksEveryKindOfAnswerAsItWouldBeSent) {
  test::Sent result;
  for (const Answer answer : {Answer::kDrive, Answer::kStopOnRoad, Answer::kReturnToRoad}) {
    for (const double steer : {0.43, -0.43, 1e308, -1e308}) {
      const double near_edge = std::copysign(beside_the_edge(model::udacity_params()), steer);
      const model::Command sent = sent_at(30.0, answer, {steer, 1.0}, result, near_edge);
      EXPECT_LT(std::fabs(sent.steer), 0.2) << static_cast<int>(answer) << ' ' << steer;
      EXPECT_EQ(result.guard.rung, Rung::kGuardStop) << static_cast<int>(answer) << ' ' << steer;
    }
  }
}

/// A negative pedal is the reverse gear of a car that stands.
TEST(GuardOnARoad, KeepsACarThatStandsOutOfReverse) {
  test::Sent result;
  EXPECT_NEAR(sent_at(0.0, Answer::kDrive, {0.3, -1.0}, result).throttle, 0.0, 1e-3);
  EXPECT_LT(sent_at(1.5, Answer::kDrive, {0.0, -1.0}, result).throttle, 0.0) << "it still brakes";
  EXPECT_LT(sent_at(10.0, Answer::kDrive, {0.0, -0.03}, result).throttle, -0.02);
}

/// How far the stop goes [m] that a guard has at hand on a straight road at 20 m/s.
double stop_at_hand(Guard& guard) {
  guard.reset();
  controller::StepResult result;
  for (int i = 1; i < 8; ++i) guard.step(at(0.04 * i), Deadline::never(), {.interval = 0.04}, result);
  const StopPlan& stop = guard.stop();
  return stop.size > 0 ? stop.points[static_cast<std::size_t>(stop.size - 1)].distance : 0.0;
}

/// A lap over a road with `grip` of what the vehicle's parameters tell.
std::shared_ptr<const road::RacingRoad> lap_with_grip(double grip) {
  std::vector<road::LinePoint> lap;
  for (int i = 0; i <= 100; ++i)
    lap.push_back({.position = {4.0 * i, 0.0}, .speed = 25.0, .left = 5.0, .right = 5.0});
  return std::make_shared<road::RacingRoad>(
      lap, 0.0, road::RacingRoad::Basis{.is_learned = true, .terms = {.grip = grip}, .is_closed = false});
}

/// Tyres that have shown less grip brake less.
TEST(GuardOnARoad, CountsItsStopsWithTheGripOfTheLap) {
  const road::RoadData straight = straight_road(200);
  model::VehicleParams vehicle = model::road_car_params();
  vehicle.brake_acceleration *= 3.0;  // grip alone is what it brakes by
  Scripted scripted;
  Guard guard{std::make_unique<test::Borrowed>(scripted), vehicle, {}, &straight};
  const double usual = stop_at_hand(guard);
  EXPECT_GT(usual, 10.0);
  guard.use_line(lap_with_grip(0.5));
  EXPECT_GT(stop_at_hand(guard), 1.5 * usual);
  guard.use_line(nullptr);
  EXPECT_EQ(stop_at_hand(guard), usual);
}

/// Without a road there is no stop at hand along it, nor what was known of its grip.
TEST(GuardOnARoad, ForgetsTheRoadWithWhatWasLearnedOfIt) {
  const road::RoadData straight = straight_road(200);
  Scripted scripted;
  Guard guard{std::make_unique<test::Borrowed>(scripted), model::road_car_params(), {}, &straight};
  guard.use_line(lap_with_grip(0.5));
  EXPECT_GT(stop_at_hand(guard), 20.0);
  guard.forget_road();
  EXPECT_EQ(guard.stop().size, 0);
  EXPECT_EQ(stop_at_hand(guard), 0.0);
}

/// The original car keeps its brakes applied at rest until they are released.
/// No prediction holds for a car whose driven wheels spin (docs/guard.md, eq. 14).
TEST(GuardOnARoad, AsksForNoMoreDriveThanTheTyresHave) {
  const road::RoadData road = straight_road(100);
  Scripted scripted;
  scripted.result.command = {.steer = 0.0, .throttle = 1.0};
  const auto sent = [&](const model::VehicleParams& vehicle) {
    Guard guard{std::make_unique<test::Borrowed>(scripted), vehicle, {.blind_time = 0.0}, &road};
    controller::StepResult result;
    for (int i = 0; i < 20; ++i) guard.step(at(0.04 * i), Deadline::never(), {.interval = 0.04}, result);
    return result.command.throttle;
  };
  model::VehicleParams vehicle = model::road_car_params();
  EXPECT_EQ(sent(vehicle), 1.0) << "has more grip than drive";
  vehicle.drive_power_per_mass = std::numeric_limits<double>::infinity();
  vehicle.drive_acceleration = 15.0;
  vehicle.drive_share_front = 0.0;
  const double grip = vehicle.friction * vehicle.load(20.0) * vehicle.front_axle / vehicle.wheelbase();
  EXPECT_NEAR(15.0 * sent(vehicle), 0.9 * grip, 0.3);
  vehicle.drive_share_front = 1.0;
  EXPECT_GT(15.0 * sent(vehicle), 0.9 * grip) << "there is more load in front";
}

TEST(GuardOnARoad, ReleasesTheBrakesOfACarThatStandsThoughItShouldDrive) {
  const road::RoadData straight = straight_road(100);
  Scripted scripted;
  Guard guard{std::make_unique<test::Borrowed>(scripted), model::udacity_params(), {}, &straight};
  scripted.result.command = {.throttle = 0.5};
  controller::StepResult result;
  int released = 0;
  for (int i = 1; i < 60; ++i) {
    model::Measurement now = at(0.04 * i, 0.0);
    now.x = 100.0;
    guard.step(now, Deadline::never(), {.interval = 0.04}, result);
    if (result.command.throttle < 0.0) ++released;
  }
  EXPECT_GE(released, 3);
  EXPECT_LE(released, 4) << "one command, every half second";
}

/// Who sees nothing has nothing to plan anew by: the stop of the last cycle that saw is driven to its end, as
/// a receiver would that is left alone.
TEST(GuardOnARoad, DrivesTheStopAtHandWhereNothingIsMeasured) {
  const road::RoadData straight = straight_road(200);
  Scripted scripted;
  Guard guard{std::make_unique<test::Borrowed>(scripted), model::road_car_params(), {}, &straight};
  controller::StepResult result;
  double time = 1.0;
  for (; time < 1.5; time += 0.04) {
    model::Measurement now = at(time);
    now.y = 1.0;
    guard.step(now, Deadline::never(), {.interval = 0.04}, result);
  }
  int stopping = 0;
  StopPlan before = guard.stop();
  for (; time < 3.5; time += 0.04) {
    model::Measurement now = at(time);
    now.x = now.y = now.psi = now.speed = kNaN;
    guard.step(now, Deadline::never(), {.interval = 0.04}, result);
    const StopPlan& stop = guard.stop();
    ASSERT_GT(stop.size, 1);
    if (guard.report().rung == Rung::kGuardStop && ++stopping > 1) {
      const StopPoint& end = stop.points[static_cast<std::size_t>(stop.size - 1)];
      const StopPoint& end_before = before.points[static_cast<std::size_t>(before.size - 1)];
      EXPECT_EQ(end.time, end_before.time) << "it ends when it would have ended";
      EXPECT_NEAR(stop.points[0].time, time + 0.1, 0.05);
      int i = 0;
      while (i + 1 < before.size && before.points[static_cast<std::size_t>(i + 1)].time <= time + 0.1) ++i;
      EXPECT_EQ(stop.points[0].command.steer, before.points[static_cast<std::size_t>(i)].command.steer);
      EXPECT_EQ(stop.points[0].command.throttle, before.points[static_cast<std::size_t>(i)].command.throttle);
      EXPECT_NEAR(end.distance, end_before.distance - 0.04 * before.points[0].speed, 1.0);
    }
    before = stop;
  }
  EXPECT_GT(stopping, 20);
}

TEST_F(GuardTest, FallsBackWithoutAnAnswerAlsoForAControllerWithoutPlans) {
  scripted_.result.command = {.steer = 0.2, .throttle = 0.5};
  step(at(1.0));
  scripted_.result.answer = Answer::kNone;
  scripted_.result.command = {.steer = -0.4, .throttle = 1.0};
  const test::Sent& result = step(at(1.7));
  EXPECT_EQ(result.guard.rung, Rung::kHoldAndBrake);
  EXPECT_EQ(result.command.steer, 0.2) << "the wheel stays where the last answer put it";
  EXPECT_LT(result.command.throttle, 0.0);
  EXPECT_EQ(result.plan.size, 0);
  EXPECT_EQ(step(at(4.0)).guard.rung, Rung::kBrake);
}

TEST_F(GuardTest, TakesACommandThatIsNotFiniteForNone) {
  for (const model::Command& bad : {model::Command{kNaN, 0.1}, model::Command{0.1, kNaN},
                                    model::Command{std::numeric_limits<double>::infinity(), 0.0}}) {
    scripted_.result.command = bad;
    const test::Sent& result = step(at(1.0));
    EXPECT_NE(result.guard.rung, Rung::kController);
    EXPECT_TRUE(std::isfinite(result.command.steer) && std::isfinite(result.command.throttle));
  }
}

/// A controller's own word on when its command acts does not count: 0.45 s early, the receiver would brake.
TEST_F(GuardTest, CountsByTheMeasuredDelay) {
  controller::Plan& plan = scripted_.result.plan;
  plan.size = 5;
  for (int i = 0; i < 5; ++i)
    plan.points[static_cast<std::size_t>(i)] = {1.0 + 0.1 * i, 2.0 * i, 0.0, 0.0, 20.0, {0.01 * i, 0.1}};
  step(at(1.0));
  scripted_.result.answer = Answer::kNone;
  scripted_.result.report.act_time = 1.05;
  model::Measurement now = at(1.0);
  now.delay = 0.4;
  EXPECT_EQ(step(now).command.steer, 0.04);
}

TEST_F(GuardTest, ShowsTheControllerNothingThatIsNotPlausible) {
  step(at(1.0));
  EXPECT_EQ(scripted_.seen.x, 20.0);
  model::Measurement jumped = at(1.04);
  jumped.y = 30.0;
  step(jumped);
  EXPECT_TRUE(std::isnan(scripted_.seen.x));
  EXPECT_EQ(scripted_.seen.time, 1.04);
}

TEST_F(GuardTest, LetsNothingOutThatTheActuatorsCannotDo) {
  scripted_.result.command = {.steer = 3.0, .throttle = 7.0};
  const test::Sent& result = step(at(1.0));
  EXPECT_EQ(result.command.steer, 0.4);
  EXPECT_EQ(result.command.throttle, 1.0);
  EXPECT_TRUE(result.guard.gated);
  EXPECT_EQ(asked_.steer, 3.0);
  scripted_.result.command = {.steer = -0.4, .throttle = 0.0};
  EXPECT_DOUBLE_EQ(step(at(1.04), {.interval = 0.04}).command.steer, 0.36) << "1 rad/s for 40 ms";
  EXPECT_TRUE(result_.guard.gated);
}

TEST_F(GuardTest, TellsTheControllerWhatWasReallySent) {
  scripted_.result.command = {.steer = 3.0, .throttle = 0.5};
  step(at(1.0));
  step(at(1.04), {.manual = model::Command{.steer = -0.1, .throttle = 0.2}});
  ASSERT_EQ(scripted_.sent.size(), 2U);
  EXPECT_EQ(scripted_.sent[0].steer, 0.4);
  EXPECT_EQ(scripted_.sent[1].steer, -0.1);
  EXPECT_EQ(result_.command.throttle, 0.2);
  EXPECT_EQ(asked_.steer, 3.0) << "a person drives; what the controller asks for is still told";
}

TEST_F(GuardTest, ForgetsEverythingOnReset) {
  scripted_.result.command = {.steer = 0.3, .throttle = 0.5};
  step(at(1.0));
  guard_.reset();
  EXPECT_EQ(scripted_.resets, 1);
  scripted_.result.answer = Answer::kNone;
  EXPECT_EQ(step(at(0.0)).command.steer, 0.0);
}

TEST_F(GuardTest, AllocatesNothingAndStaysInBoundsWhateverComes) {
  Random random(11);
  const double strange[] = {kNaN, std::numeric_limits<double>::infinity(), -1e308, 1e9, 0.0, 0.3, -0.2};
  const auto any = [&] { return strange[random.bits() % 7]; };
  double last = 0.0;
  const test::AllocationGuard counter;
  for (int i = 0; i < 500; ++i) {
    scripted_.result.answer = static_cast<Answer>(random.bits() % 4);
    scripted_.result.command = {any(), any()};
    scripted_.result.plan.size = static_cast<int>(random.bits() % 300) - 10;
    scripted_.result.report.act_time = any();
    for (controller::PlanPoint& point : scripted_.result.plan.points)
      point = {any(), any(), any(), any(), any(), {any(), any()}};
    model::Measurement now = at(0.04 * i);
    if (random.bits() % 3 == 0) now.x = any();
    if (random.bits() % 3 == 0) now.speed = any();
    const test::Sent& result = step(now, {.interval = 0.04});
    ASSERT_LE(std::fabs(result.command.steer), 0.4) << i;
    ASSERT_LE(std::fabs(result.command.throttle), 1.0) << i;
    ASSERT_LE(std::fabs(result.command.steer - last), 0.04 + 1e-12) << i;
    last = result.command.steer;
  }
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace chicane::safety
