// SPDX-License-Identifier: MIT
#include "chicane/sim/fault.hpp"

#include "chicane/base/math.hpp"
#include "support/chicane_test.hpp"

namespace chicane::sim {
namespace {

model::Measurement measurement(double time = 0.0) {
  model::Measurement now;
  now.time = time;
  now.x = 10.0 + time;
  now.y = 20.0;
  now.psi = 0.5 * kPi;
  now.speed = 15.0;
  now.steer = 0.1;
  now.throttle = 0.2;
  now.delay = 0.1;
  now.waypoint_count = 6;
  return now;
}

Fault fault(std::string_view name) { return fault_named(name).value(); }

/// In which these faults are on.
FaultLab lab_of(const std::vector<FaultEvent>& events) {
  FaultLab lab(events, 7);
  lab.update(0.0);
  return lab;
}
FaultLab lab_with(std::string_view name, double strength) {
  return lab_of({{fault(name), 0.0, 10.0, strength}});
}
FaultLab lab_with(std::string_view name) { return lab_with(name, kind_of(fault(name)).strength); }

TEST(FaultKinds, AreNamedOnceAndMeanSomething) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < fault_kinds().size(); ++i) {
    const FaultKind& kind = fault_kinds()[i];
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_EQ(fault_named(kind.name), static_cast<Fault>(i));
    EXPECT_TRUE(kind.meaning.ends_with('.')) << kind.name;
    EXPECT_GT(kind.duration, 0.0);
    EXPECT_GE(kind.strength, kind.weakest) << kind.name;
    EXPECT_LE(kind.strength, kind.strongest) << kind.name;
  }
  EXPECT_EQ(fault_named("no_such"), std::nullopt);
}

TEST(FaultKinds, KeepThePlacesThatRecordingsKnow) {
  std::vector<std::string_view> names;
  for (const FaultKind& kind : fault_kinds()) names.push_back(kind.name);
  ASSERT_GE(names.size(), 18U);
  ASSERT_LE(names.size(), kMostFaults);
  names.resize(18);
  EXPECT_THAT(names,
              ElementsAre("link_lost", "frozen_sensor", "nan_measurement", "position_jump", "gps_noise",
                          "speed_sensor_zero", "waypoints_missing", "half_grip", "ice_patch", "side_wind",
                          "weak_brakes", "steering_stuck", "steering_offset", "throttle_stuck", "slow_solver",
                          "dead_controller", "delay_doubled", "command_dropped"));
}

TEST(FaultLab, BeginsAndEndsWhenItIsToldOrSwitched) {
  const Fault grip = fault("half_grip"), wind = fault("side_wind"), ice = fault("ice_patch");
  FaultLab lab(std::vector<FaultEvent>{{grip, 2.0, 3.0, 0.5}, {wind, 4.0, 3.0, -1.5}}, 1);
  for (const auto& [time, has_grip, has_wind] : {std::tuple{0.0, false, false},
                                                 {1.99, false, false},
                                                 {2.0, true, false},
                                                 {4.5, true, true},
                                                 {5.5, false, true},
                                                 {7.0, false, false},
                                                 {9.0, false, false}}) {
    lab.update(time);
    EXPECT_EQ(lab.bits(), (has_grip ? 1U << 7U : 0U) | (has_wind ? 1U << 9U : 0U)) << time;
    EXPECT_EQ(lab.grip(), has_grip ? 0.5 : 1.0);
    EXPECT_EQ(lab.side_acceleration(), has_wind ? -1.5 : 0.0);
  }
  lab.reset();
  lab.update(2.5);
  EXPECT_TRUE(lab.is_on(grip)) << "a new run has the same schedule";
  FaultLab switched({}, 1);
  switched.set(ice, true, 10.0);
  switched.update(10.1);
  switched.set(ice, true, 10.1);  // already on: its end stays
  EXPECT_EQ(switched.grip(), kind_of(ice).strength);
  switched.update(10.0 + kind_of(ice).duration);
  EXPECT_EQ(switched.bits(), 0U);
  switched.set(fault("link_lost"), true, 20.0);
  switched.set(fault("link_lost"), false, 20.1);
  EXPECT_EQ(switched.bits(), 0U);
}

TEST(FaultLab, ChangesNothingWhenNothingIsOn) {
  FaultLab lab({}, 1);
  lab.update(1.0);
  const model::Measurement measured = lab.seen(measurement());
  EXPECT_EQ(measured.x, 10.0);
  EXPECT_EQ(measured.waypoint_count, 6);
  EXPECT_TRUE(lab.is_delivered());
  EXPECT_EQ(lab.done({0.1, -0.2}).steer, 0.1);
  EXPECT_EQ(lab.done({0.1, -0.2}).throttle, -0.2);
  EXPECT_EQ(lab.extra_delay(0.1), 0.0);
  EXPECT_EQ(lab.deadline_questions(), 0U);
}

TEST(FaultLab, SpoilsMeasurements) {
  const model::Measurement lost = lab_with("link_lost").seen(measurement());
  EXPECT_TRUE(std::isnan(lost.x + lost.speed));
  EXPECT_TRUE(std::isnan(lost.steer));
  EXPECT_EQ(lost.waypoint_count, 0);
  EXPECT_EQ(lost.time, 0.0);

  const model::Measurement broken = lab_with("nan_measurement").seen(measurement());
  EXPECT_TRUE(std::isnan(broken.x) && std::isnan(broken.y) && std::isnan(broken.psi) &&
              std::isnan(broken.speed));
  EXPECT_EQ(broken.waypoint_count, 6);

  const model::Measurement jump = lab_with("position_jump", 5.0).seen(measurement());
  EXPECT_NEAR(jump.x, 5.0, 1e-12);  // the car looks along +y: left is −x
  EXPECT_NEAR(jump.y, 20.0, 1e-12);

  EXPECT_EQ(lab_with("speed_sensor_zero").seen(measurement()).speed, 0.0);
  EXPECT_EQ(lab_with("waypoints_missing").seen(measurement()).waypoint_count, 0);

  FaultLab frozen = lab_with("frozen_sensor");
  static_cast<void>(frozen.seen(measurement(1.0)));
  const model::Measurement later = frozen.seen(measurement(3.0));
  EXPECT_EQ(later.x, 11.0);
  EXPECT_EQ(later.time, 3.0);

  FaultLab noisy = lab_with("gps_noise", 0.5);
  double sum = 0.0;
  constexpr int kSamples = 4000;
  for (int i = 0; i < kSamples; ++i) sum += std::pow(noisy.seen(measurement()).x - 10.0, 2);
  EXPECT_NEAR(std::sqrt(sum / kSamples), 0.5, 0.03);  // five standard deviations of the estimate
}

TEST(FaultLab, SpoilsCommandsOnTheirWayAndAtTheActuators) {
  EXPECT_FALSE(lab_with("dead_controller").is_delivered());
  FaultLab lossy = lab_with("command_dropped", 0.5);
  int delivered = 0;
  for (int i = 0; i < 1000; ++i) delivered += lossy.is_delivered() ? 1 : 0;
  EXPECT_NEAR(delivered, 500, 80);  // five standard deviations
  EXPECT_NEAR(lab_with("delay_doubled").extra_delay(0.1), 0.1, 1e-15);
  EXPECT_EQ(lab_with("slow_solver").deadline_questions(), 1U);

  FaultLab stuck = lab_with("steering_stuck");
  EXPECT_EQ(stuck.done({0.1, 0.5}).steer, 0.1);
  EXPECT_EQ(stuck.done({-0.2, 0.7}).steer, 0.1);
  EXPECT_EQ(stuck.done({-0.2, 0.7}).throttle, 0.7);
  FaultLab pedal = lab_with("throttle_stuck");
  EXPECT_EQ(pedal.done({0.1, 0.5}).throttle, 0.5);
  EXPECT_EQ(pedal.done({0.1, -1.0}).throttle, 0.5);
  EXPECT_NEAR(lab_with("steering_offset", 2.0).done({0.1, 0.0}).steer, 0.1 + degrees_to_radians(2.0), 1e-15);
  EXPECT_EQ(lab_with("weak_brakes", 0.25).done({0.0, -0.8}).throttle, -0.2);
  EXPECT_EQ(lab_with("weak_brakes", 0.25).done({0.0, 0.8}).throttle, 0.8);
}

TEST(FaultLab, HasFaultsThatActTogether) {
  FaultLab lost =
      lab_of({default_event(fault("link_lost"), 0.0), default_event(fault("frozen_sensor"), 0.0)});
  EXPECT_TRUE(std::isnan(lost.seen(measurement()).x)) << "whatever a sensor that stands still would say";
  FaultLab weak = lab_of({{fault("weak_brakes"), 0.0, 9.0, 0.5}, {fault("throttle_stuck"), 0.0, 9.0, 1.0}});
  EXPECT_EQ(weak.done({0.0, -0.8}).throttle, -0.4);
  EXPECT_EQ(weak.done({0.0, 0.3}).throttle, -0.4);
  FaultLab alone = lab_with("gps_noise");
  FaultLab together =
      lab_of({default_event(fault("gps_noise"), 0.0), default_event(fault("command_dropped"), 0.0)});
  for (int i = 0; i < 20; ++i) {
    static_cast<void>(together.is_delivered());
    EXPECT_EQ(alone.seen(measurement()).x, together.seen(measurement()).x);
  }
}

}  // namespace
}  // namespace chicane::sim
